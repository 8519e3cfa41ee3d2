// validation/app/verbs.hpp: the verbs of the command, one file each.
#pragma once

#include "validation/app/common.hpp"

namespace plumbline::app {

void register_render(CLI::App& app, Action& chosen);
void register_merge(CLI::App& app, Action& chosen);
void register_gather(CLI::App& app, Action& chosen);
void register_project(CLI::App& app, Action& chosen);
void register_bake(CLI::App& app, Action& chosen);
void register_compress(CLI::App& app, Action& chosen);
void register_relight(CLI::App& app, Action& chosen);
void register_inspect(CLI::App& app, Action& chosen);
void register_compare(CLI::App& app, Action& chosen);
void register_validate(CLI::App& app, Action& chosen);
void register_identify(CLI::App& app, Action& chosen);
void register_conventions(CLI::App& app, Action& chosen);
void register_conform(CLI::App& app, Action& chosen);
void register_bench(CLI::App& app, Action& chosen);
void register_normal_basis(CLI::App& app, Action& chosen);
void register_scenes(CLI::App& app, Action& chosen);

}  // namespace plumbline::app
