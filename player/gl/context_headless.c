#include "player/gl/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <stdlib.h>
#include <string.h>

struct weft_headless {
    EGLDisplay display;
    EGLContext context;
};

enum { MAX_DEVICES = 16 };

static EGLContext create_context(EGLDisplay display, weft_gl_profile profile)
{
    static const EGLint core[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    static const EGLint es[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    eglBindAPI(profile == WEFT_GL_ES ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, profile == WEFT_GL_ES ? es : core);
}

/* True where the display gives a current context; otherwise nothing of it stays open. */
static bool open_display(weft_headless *headless, EGLDisplay display, weft_gl_profile profile)
{
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL))
        return false;
    EGLContext context = create_context(display, profile);
    if (context != EGL_NO_CONTEXT && eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        headless->display = display;
        headless->context = context;
        return true;
    }
    if (context != EGL_NO_CONTEXT)
        eglDestroyContext(display, context);
    eglTerminate(display);
    return false;
}

static bool wants_software(void)
{
    const char *value = getenv("LIBGL_ALWAYS_SOFTWARE");
    return value && (strcmp(value, "1") == 0 || strcmp(value, "true") == 0);
}

static bool open_device(weft_headless *headless, weft_gl_profile profile)
{
    if (wants_software() || !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
        !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device"))
        return false;
    EGLDeviceEXT device[MAX_DEVICES];
    EGLint count = 0;
    if (!eglQueryDevicesEXT(MAX_DEVICES, device, &count))
        return false;
    for (EGLint i = 0; i < count; i++) {
        const char *extensions = eglQueryDeviceStringEXT(device[i], EGL_EXTENSIONS);
        if (extensions && strstr(extensions, "EGL_MESA_device_software"))
            continue;
        EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device[i], NULL);
        if (open_display(headless, display, profile))
            return true;
    }
    return false;
}

static bool open_surfaceless(weft_headless *headless, weft_gl_profile profile)
{
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        return false;
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    return open_display(headless, display, profile);
}

weft_code weft_headless_create(weft_gl_profile profile, weft_headless **result, weft_error *error)
{
    *result = NULL;
    weft_headless *headless = calloc(1, sizeof *headless);
    if (!headless)
        return weft_fail_memory(error, "graphics context", sizeof *headless);
    if (!open_device(headless, profile) && !open_surfaceless(headless, profile)) {
        free(headless);
        return weft_fail(error, WEFT_SYSTEM,
                         "no %s without a display: EGL found neither a device nor Mesa's rasteriser",
                         profile == WEFT_GL_ES ? "OpenGL ES 3.0" : "OpenGL 3.3");
    }
    *result = headless;
    return WEFT_OK;
}

void weft_headless_free(weft_headless *headless)
{
    if (!headless)
        return;
    eglMakeCurrent(headless->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(headless->display, headless->context);
    eglTerminate(headless->display);
    eglReleaseThread();
    free(headless);
}

const char *weft_gl_renderer(void)
{
    return (const char *)glGetString(GL_RENDERER);
}
