#include "gl_context.hpp"

#include <fmt/format.h>

#include "reference/base/error.hpp"

namespace plumbline::test {

std::unique_ptr<relight::gl::Context> context_of(relight::gl::Provider provider) {
  try {
    auto context = std::make_unique<relight::gl::Context>(relight::gl::settings_from_environment(provider));
    fmt::print("{}\n", context->description());
    return context;
  } catch (const DeviceError& error) {
    const std::string reason = error.what();
    EXPECT_TRUE(reason.starts_with(provider == relight::gl::Provider::osmesa ? "OSMesa: " : "EGL: "))
        << reason;
    EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    fmt::print("no {} here: {}\n", relight::gl::to_string(provider), reason);
    return nullptr;
  }
}

std::string name_of(const testing::TestParamInfo<relight::gl::Provider>& provider) {
  return std::string(relight::gl::to_string(provider.param));
}

}  // namespace plumbline::test
