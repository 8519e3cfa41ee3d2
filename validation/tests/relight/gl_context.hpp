// validation/tests/relight/gl_context.hpp: contexts for tests, which never pass by being left out.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "prt/relight/gl/context.hpp"

namespace plumbline::test {

/// The context; or null where the machine has no such provider, once it is certain that this is said in one line that names
/// it. What there is and is not is printed.
[[nodiscard]] std::unique_ptr<relight::gl::Context> context_of(relight::gl::Provider provider);

/// Tests of both providers, each by its own name.
class OnEachProvider : public testing::TestWithParam<relight::gl::Provider> {};
[[nodiscard]] std::string name_of(const testing::TestParamInfo<relight::gl::Provider>& provider);

}  // namespace plumbline::test
