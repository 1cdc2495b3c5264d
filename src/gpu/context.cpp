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
    if (!has_extension(display, "EGL_KHR_surfaceless_context") || !eglBindAPI(EGL_OPENGL_API)) return false;
    EGLConfig config = nullptr;
    if (!has_extension(display, "EGL_KHR_no_config_context")) {
        const std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                           EGL_PBUFFER_BIT, EGL_NONE};
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count < 1) return false;
    }
    const std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION,
                                        3,
                                        EGL_CONTEXT_MINOR_VERSION,
                                        3,
                                        EGL_CONTEXT_OPENGL_PROFILE_MASK,
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
    return true;
}

Result<std::unique_ptr<GlContext>> GlContext::make() {
    std::unique_ptr<GlContext> made(new GlContext);
    made->old_api_ = eglQueryAPI();
    made->old_display_ = eglGetCurrentDisplay();
    made->old_context_ = eglGetCurrentContext();
    made->old_draw_ = eglGetCurrentSurface(EGL_DRAW);
    made->old_read_ = eglGetCurrentSurface(EGL_READ);
    if (made->open(surfaceless_display()) || made->open(eglGetDisplay(EGL_DEFAULT_DISPLAY)) ||
        made->open(device_display()))
        return made;
    return refuse(RefusalKind::unavailable, "OpenGL",
                  "no OpenGL 3.3 without a window; on Debian install libegl-mesa0 and libgl1-mesa-dri");
}

GlContext::~GlContext() {
    if (context_ != EGL_NO_CONTEXT) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
    eglBindAPI(old_api_);
    if (old_context_ != EGL_NO_CONTEXT) eglMakeCurrent(old_display_, old_draw_, old_read_, old_context_);
}

}  // namespace freiform
