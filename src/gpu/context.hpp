// An OpenGL 3.3 context without a window.
#pragma once
#include <freiform/core/result.hpp>

#include <epoxy/egl.h>
#include <memory>

namespace freiform {

// Current in the thread that made it, until it is destroyed; then what was current before is again. All
// objects of OpenGL made in between end with it.
class GlContext {
public:
    static Result<std::unique_ptr<GlContext>> make();
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

private:
    GlContext() = default;
    bool open(EGLDisplay display);

    EGLDisplay display_ = EGL_NO_DISPLAY, old_display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT, old_context_ = EGL_NO_CONTEXT;
    EGLSurface old_draw_ = EGL_NO_SURFACE, old_read_ = EGL_NO_SURFACE;
    EGLenum old_api_ = EGL_OPENGL_ES_API;
};

}  // namespace freiform
