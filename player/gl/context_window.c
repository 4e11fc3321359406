#include "player/gl/context.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdlib.h>

struct weft_window {
    GLFWwindow *handle;
    weft_window_events events;
    double x, y; /* of the pointer at the last event: glfwGetCursorPos would tell where it has come to since, and after
                    a slow frame that is far from where the button was pressed */
    int left, top, width, height; /* in the desktop, before it filled the screen */
    bool has_events;              /* since they were asked for */
};

/* GLFW counts positions in screen coordinates, which differ from pixels on dense displays. */
static void pixel_position(GLFWwindow *handle, double *x, double *y)
{
    int width, height, pixel_width, pixel_height;
    glfwGetWindowSize(handle, &width, &height);
    glfwGetFramebufferSize(handle, &pixel_width, &pixel_height);
    *x *= width > 0 ? (double)pixel_width / width : 1;
    *y *= height > 0 ? (double)pixel_height / height : 1;
}

static weft_window *stirred(GLFWwindow *handle)
{
    weft_window *window = glfwGetWindowUserPointer(handle);
    window->has_events = true;
    return window;
}

static void on_button(GLFWwindow *handle, int button, int action, int modifiers)
{
    weft_window *window = stirred(handle);
    window->events.press(window->events.context, button, action == GLFW_PRESS, modifiers, window->x, window->y);
}

static void on_move(GLFWwindow *handle, double x, double y)
{
    weft_window *window = stirred(handle);
    pixel_position(handle, &x, &y);
    window->x = x;
    window->y = y;
    window->events.move(window->events.context, x, y);
}

static void on_scroll(GLFWwindow *handle, double x, double y)
{
    (void)x;
    weft_window *window = stirred(handle);
    window->events.scroll(window->events.context, y);
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int modifiers)
{
    (void)scancode;
    weft_window *window = stirred(handle);
    window->events.key(window->events.context, key, action, modifiers);
}

static void on_drop(GLFWwindow *handle, int count, const char **path)
{
    weft_window *window = stirred(handle);
    for (int i = 0; i < count; i++)
        window->events.drop(window->events.context, path[i]);
}

/* ---- What changes how the window looks, and nothing else ---- */

static void on_refresh(GLFWwindow *handle)
{
    stirred(handle);
}

static void on_size(GLFWwindow *handle, int width, int height)
{
    (void)width, (void)height;
    stirred(handle);
}

static void on_enter_or_focus(GLFWwindow *handle, int comes)
{
    (void)comes;
    stirred(handle);
}

static void on_character(GLFWwindow *handle, unsigned character)
{
    (void)character;
    stirred(handle);
}

static void listen(GLFWwindow *handle)
{
    glfwSetMouseButtonCallback(handle, on_button);
    glfwSetCursorPosCallback(handle, on_move);
    glfwSetScrollCallback(handle, on_scroll);
    glfwSetKeyCallback(handle, on_key);
    glfwSetDropCallback(handle, on_drop);
    glfwSetWindowRefreshCallback(handle, on_refresh);
    glfwSetFramebufferSizeCallback(handle, on_size);
    glfwSetCursorEnterCallback(handle, on_enter_or_focus);
    glfwSetWindowFocusCallback(handle, on_enter_or_focus);
    glfwSetCharCallback(handle, on_character);
}

static weft_code fail_glfw(weft_error *error, const char *action)
{
    const char *cause = NULL;
    glfwGetError(&cause);
    return weft_fail(error, WEFT_SYSTEM, "cannot %s: %s", action, cause ? cause : "GLFW gives no reason");
}

static GLFWwindow *open_window(const char *title, int width, int height)
{
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    return glfwCreateWindow(width, height, title, NULL, NULL);
}

weft_code weft_window_create(const char *title, int width, int height, const weft_window_events *events,
                             weft_window **result, weft_error *error)
{
    *result = NULL;
    if (!glfwInit())
        return fail_glfw(error, "open a display");
    weft_window *window = calloc(1, sizeof *window);
    GLFWwindow *handle = window ? open_window(title, width, height) : NULL;
    if (!handle) {
        weft_code code = window ? fail_glfw(error, "open a window with OpenGL 3.3")
                                : weft_fail_memory(error, "window", sizeof *window);
        free(window);
        glfwTerminate();
        return code;
    }
    *window = (weft_window){.handle = handle, .events = *events};
    glfwSetWindowUserPointer(handle, window);
    listen(handle);
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(1);
    *result = window;
    return WEFT_OK;
}

void weft_window_free(weft_window *window)
{
    if (!window)
        return;
    glfwDestroyWindow(window->handle);
    glfwTerminate();
    free(window);
}

bool weft_window_poll(weft_window *window, double wait_s)
{
    if (wait_s > 0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    return !glfwWindowShouldClose(window->handle);
}

bool weft_window_take_events(weft_window *window)
{
    bool had_events = window->has_events;
    window->has_events = false;
    return had_events;
}

void weft_window_close(weft_window *window)
{
    glfwSetWindowShouldClose(window->handle, GLFW_TRUE);
}

/* The screen with the window's middle, and its mode; the first where that lies beside all. One that was just unplugged
 * has no mode; NULL where none has. */
static GLFWmonitor *screen_of(GLFWwindow *handle, const GLFWvidmode **mode)
{
    int count, left, top, width, height;
    GLFWmonitor **screen = glfwGetMonitors(&count), *chosen = NULL;
    glfwGetWindowPos(handle, &left, &top);
    glfwGetWindowSize(handle, &width, &height);
    for (int i = 0; i < count; i++) {
        int x, y;
        const GLFWvidmode *found = glfwGetVideoMode(screen[i]);
        if (!found)
            continue;
        glfwGetMonitorPos(screen[i], &x, &y);
        int right = left + width / 2 - x, down = top + height / 2 - y;
        bool is_here = right >= 0 && down >= 0 && right < found->width && down < found->height;
        if (is_here || !chosen) {
            chosen = screen[i];
            *mode = found;
        }
        if (is_here)
            break;
    }
    return chosen;
}

void weft_window_set_full_screen(weft_window *w, bool full)
{
    const GLFWvidmode *mode = NULL;
    GLFWmonitor *screen = full ? screen_of(w->handle, &mode) : NULL;
    if (full == (glfwGetWindowMonitor(w->handle) != NULL) || (full && !screen))
        return;
    if (!full) {
        glfwSetWindowMonitor(w->handle, NULL, w->left, w->top, w->width, w->height, GLFW_DONT_CARE);
        return;
    }
    glfwGetWindowPos(w->handle, &w->left, &w->top);
    glfwGetWindowSize(w->handle, &w->width, &w->height);
    glfwSetWindowMonitor(w->handle, screen, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void weft_window_size(const weft_window *window, int *width, int *height)
{
    glfwGetFramebufferSize(window->handle, width, height);
}

void weft_window_show(weft_window *window)
{
    glfwSwapBuffers(window->handle);
}

void *weft_window_handle(const weft_window *window)
{
    return window->handle;
}

double weft_window_scale(const weft_window *window)
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(window->handle, &x, &y);
    return (double)x > 0 ? (double)x : 1;
}
