#include "validation/app/verbs.hpp"
namespace plumbline::app {
void register_validate(CLI::App&, Action&) {}
}  // namespace plumbline::app
