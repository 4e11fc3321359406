/* Drops a file on a window as a file manager does (X drag and drop, version 5). Usage: drop_file WINDOW PATH */
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERSION = 5, ENOUGH_EVENTS = 100 };

typedef struct drop {
    Display *display;
    Window source, target;
    Atom uri_list;
    char uri[PATH_MAX + 16];
} drop;

static Atom atom(const drop *d, const char *name)
{
    return XInternAtom(d->display, name, False);
}

static void tell(const drop *d, const char *type, const long data[4])
{
    XEvent event = {.xclient = {.type = ClientMessage, .window = d->target, .format = 32}};
    event.xclient.message_type = atom(d, type);
    event.xclient.data.l[0] = (long)d->source;
    for (int i = 0; i < 4; i++)
        event.xclient.data.l[i + 1] = data[i];
    XSendEvent(d->display, d->target, False, NoEventMask, &event);
}

/* The target asks for what was dropped. */
static void answer(const drop *d, const XSelectionRequestEvent *request)
{
    XChangeProperty(d->display, request->requestor, request->property, request->target, 8, PropModeReplace,
                    (const unsigned char *)d->uri, (int)strlen(d->uri));
    XEvent event = {.xselection = {.type = SelectionNotify, .requestor = request->requestor}};
    event.xselection.selection = request->selection;
    event.xselection.target = request->target;
    event.xselection.property = request->property;
    event.xselection.time = request->time;
    XSendEvent(d->display, request->requestor, False, NoEventMask, &event);
}

/* Until the target has finished. */
static int serve(const drop *d)
{
    for (int i = 0; i < ENOUGH_EVENTS; i++) {
        XEvent event;
        XNextEvent(d->display, &event);
        if (event.type == SelectionRequest)
            answer(d, &event.xselectionrequest);
        else if (event.type == ClientMessage && event.xclient.message_type == atom(d, "XdndFinished"))
            return EXIT_SUCCESS;
        XFlush(d->display);
    }
    return EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    char path[PATH_MAX];
    drop d = {.display = XOpenDisplay(NULL)};
    if (argc != 3 || !d.display || !realpath(argv[2], path))
        return EXIT_FAILURE;
    d.target = (Window)strtoul(argv[1], NULL, 0);
    d.source = XCreateSimpleWindow(d.display, DefaultRootWindow(d.display), 0, 0, 1, 1, 0, 0, 0);
    d.uri_list = atom(&d, "text/uri-list");
    snprintf(d.uri, sizeof d.uri, "file://%s\r\n", path);
    XSetSelectionOwner(d.display, atom(&d, "XdndSelection"), d.source, CurrentTime);
    tell(&d, "XdndEnter", (long[]){VERSION << 24, (long)d.uri_list, 0, 0});
    tell(&d, "XdndPosition", (long[]){0, 0, CurrentTime, (long)atom(&d, "XdndActionCopy")});
    tell(&d, "XdndDrop", (long[]){0, CurrentTime, 0, 0});
    int status = serve(&d);
    XCloseDisplay(d.display);
    return status;
}
