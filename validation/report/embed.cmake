# cmake -DINPUT=file -DNAMESPACE=name -DHEADER=path -DFUNCTION=name -DOUTPUT=out.cpp -P embed.cmake
# Writes a C++ file in which NAMESPACE::FUNCTION(), declared in HEADER, returns the bytes of INPUT.
file(READ "${INPUT}" bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR size "${digits} / 2")
string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "// Generated from ${INPUT}.
#include \"${HEADER}\"

namespace {
constexpr unsigned char kBytes[] = {
${bytes}
0};
}  // namespace

namespace ${NAMESPACE} {
std::string_view ${FUNCTION}() {
  return {reinterpret_cast<const char*>(kBytes), ${size}U};
}
}  // namespace ${NAMESPACE}
")
