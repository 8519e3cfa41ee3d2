// Mesa's off-screen interface. Its header has left Mesa with the library (25.1), so the few facts that are needed of it
// stand here: they make the build independent of whether there is one.
#include <fmt/format.h>

#include <array>

#include "prt/relight/gl/functions.hpp"
#include "prt/relight/gl/library.hpp"
#include "prt/relight/gl/platform.hpp"
#include "reference/base/error.hpp"

namespace plumbline::relight::gl {
namespace {

using OsmesaContext = void*;
constexpr int kFormat = 0x22;
constexpr int kProfile = 0x33;
constexpr int kCoreProfile = 0x34;
constexpr int kMajorVersion = 0x36;
constexpr int kMinorVersion = 0x37;

// The context wants a colour buffer of its own; everything is drawn to framebuffer objects instead.
constexpr int kBufferSize = 16;

class Osmesa final : public Platform {
 public:
  Osmesa(const std::string& libraries, Version version)
      : library_("OSMesa", libraries),
        address_(library_.require<decltype(address_)>("OSMesaGetProcAddress")),
        destroy_(library_.require<decltype(destroy_)>("OSMesaDestroyContext")),
        make_current_(library_.require<decltype(make_current_)>("OSMesaMakeCurrent")) {
    const auto create =
        library_.require<OsmesaContext (*)(const int*, OsmesaContext)>("OSMesaCreateContextAttribs");
    const int attributes[] = {kFormat,       GL_RGBA,       kProfile,
                              kCoreProfile,  kMajorVersion, version.major,
                              kMinorVersion, version.minor, 0};
    context_ = create(attributes, nullptr);
    if (context_ == nullptr) {
      throw DeviceError(fmt::format("OSMesa: it gives no context of OpenGL {}.{} core profile", version.major,
                                    version.minor));
    }
    if (make_current_(context_, buffer_.data(), GL_UNSIGNED_BYTE, kBufferSize, kBufferSize) == 0) {
      destroy_(context_);
      throw DeviceError("OSMesa: the context cannot be made current");
    }
  }
  ~Osmesa() override {
    make_current_(nullptr, nullptr, 0, 0, 0);
    destroy_(context_);
  }
  [[nodiscard]] void* address(const char* function) const override { return address_(function); }

 private:
  Library library_;
  void* (*address_)(const char*);
  void (*destroy_)(OsmesaContext);
  unsigned char (*make_current_)(OsmesaContext, void*, GLenum, GLsizei, GLsizei);
  std::array<unsigned char, std::size_t{4} * kBufferSize * kBufferSize> buffer_{};
  OsmesaContext context_ = nullptr;
};

}  // namespace

std::unique_ptr<Platform> make_osmesa(const std::string& libraries, Version version) {
  return std::make_unique<Osmesa>(libraries, version);
}

}  // namespace plumbline::relight::gl
