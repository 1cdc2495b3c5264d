// Three displays are tried: Mesa's surfaceless one, which needs neither window system nor graphics card; the
// default one, which serves drivers of other makers; the first device, for those that offer nothing else.
// Displays are not terminated: they belong to the process, and somebody else may use the same one.
#include "gpu/context.hpp"

#include <array>
#include <epoxy/gl.h>
#include <string_view>

namespace freiform {
namespace {

bool has_extension(EGLDisplay display, std::string_view name) {
    const char* list = eglQueryString(display, EGL_EXTENSIONS);
    if (!list) return false;
    const std::string padded = text(" ", list, " ");
    return padded.find(text(" ", name, " ")) != std::string::npos;
}

EGLDisplay surfaceless_display() {
    if (!has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base") ||
        !has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        return EGL_NO_DISPLAY;
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
}

EGLDisplay device_display() {
    if (!has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
        !has_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration"))
        return EGL_NO_DISPLAY;
    EGLDeviceEXT device = nullptr;
    EGLint count = 0;
    if (!eglQueryDevicesEXT(1, &device, &count) || count < 1) return EGL_NO_DISPLAY;
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
}

}  // namespace

bool GlContext::open(EGLDisplay display) {
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return false;
    const bool es = version_ == GlVersion::es_30;
    if (!has_extension(display, "EGL_KHR_surfaceless_context") ||
        !eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API))
        return false;
    EGLConfig config = nullptr;
    if (!has_extension(display, "EGL_KHR_no_config_context")) {
        const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT,
                                           EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count < 1) return false;
    }
    // OpenGL ES has no profiles: there the list ends before it.
    const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                        version_ == GlVersion::core_43 ? 4 : 3,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        es ? 0 : 3,
                                        es ? EGL_NONE : EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                        EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, version.data());
    if (context == EGL_NO_CONTEXT) return false;
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        eglDestroyContext(display, context);
        return false;
    }
    display_ = display;
    context_ = context;
    current_ = true;
    return true;
}

void GlContext::remember() {
    old_api_ = eglQueryAPI();
    old_display_ = eglGetCurrentDisplay();
    old_context_ = eglGetCurrentContext();
    old_draw_ = eglGetCurrentSurface(EGL_DRAW);
    old_read_ = eglGetCurrentSurface(EGL_READ);
}

Result<std::unique_ptr<GlContext>> GlContext::make(GlVersion version) {
    std::unique_ptr<GlContext> made(new GlContext);
    made->version_ = version;
    made->remember();
    if (made->open(surfaceless_display()) || made->open(eglGetDisplay(EGL_DEFAULT_DISPLAY)) ||
        made->open(device_display()))
        return made;
    const std::string_view wanted = version == GlVersion::core_33   ? "OpenGL 3.3"
                                    : version == GlVersion::core_43 ? "OpenGL 4.3"
                                                                    : "OpenGL ES 3.0";
    return refuse(
        RefusalKind::unavailable, "OpenGL",
        text("no ", wanted, " without a window; on Debian install libegl-mesa0 and libgl1-mesa-dri"));
}

bool GlContext::use() {
    if (current_) return true;
    remember();
    current_ = eglBindAPI(version_ == GlVersion::es_30 ? EGL_OPENGL_ES_API : EGL_OPENGL_API) &&
               eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    return current_;
}

void GlContext::release() {
    if (!current_) return;
    current_ = false;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglBindAPI(old_api_);
    if (old_context_ != EGL_NO_CONTEXT) eglMakeCurrent(old_display_, old_draw_, old_read_, old_context_);
}

GlContext::~GlContext() {
    release();
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
}

}  // namespace freiform
