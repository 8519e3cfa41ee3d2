# cmake -DINPUT=file -DFUNCTION=name -DOUTPUT=out.cpp -P embed.cmake
# Writes a C++ file in which plumbline::report::assets::FUNCTION() returns the bytes of INPUT.
file(READ "${INPUT}" bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "// Generated from ${INPUT}.
#include \"validation/report/assets.hpp\"

namespace {
constexpr unsigned char kBytes[] = {
${bytes}
0};
}  // namespace

namespace plumbline::report::assets {
std::string_view ${FUNCTION}() {
  return {reinterpret_cast<const char*>(kBytes), ${size}U};
}
}  // namespace plumbline::report::assets
")
