// An OpenGL context without a window.
#pragma once
#include <freiform/core/result.hpp>

#include <epoxy/egl.h>
#include <memory>

namespace freiform {

enum class GlVersion { core_33, core_43, es_30 };

// Current in the thread that made it, until it is destroyed or released; then what was current before is
// again. All objects of OpenGL made in between end with it.
class GlContext {
public:
    static Result<std::unique_ptr<GlContext>> make(GlVersion version = GlVersion::core_33);
    ~GlContext();
    bool use();  // again current, until the next release
    void release();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

private:
    GlContext() = default;
    bool open(EGLDisplay display);
    void remember();

    GlVersion version_ = GlVersion::core_33;
    bool current_ = false;
    EGLDisplay display_ = EGL_NO_DISPLAY, old_display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT, old_context_ = EGL_NO_CONTEXT;
    EGLSurface old_draw_ = EGL_NO_SURFACE, old_read_ = EGL_NO_SURFACE;
    EGLenum old_api_ = EGL_OPENGL_ES_API;
};

}  // namespace freiform
