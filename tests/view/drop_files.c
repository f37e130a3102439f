/* drop_files WINDOW PATH...: drops files onto a window of X11 as a file manager does, by XDND. */
#define _POSIX_C_SOURCE 200809L
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define VERSION 5
#define TRIES 500 /* pauses of 10 ms */

struct drag {
    Display *display;
    Window source, target;
    char uris[16384];
};

static Atom atom(const struct drag *drag, const char *name)
{
    return XInternAtom(drag->display, name, False);
}

static void send(const struct drag *drag, const char *type, const long data[4])
{
    XEvent event = {.xclient = {.type = ClientMessage,
                                .window = drag->target,
                                .message_type = atom(drag, type),
                                .format = 32}};
    event.xclient.data.l[0] = (long)drag->source;
    for (int i = 0; i < 4; i++)
        event.xclient.data.l[i + 1] = data[i];
    XSendEvent(drag->display, drag->target, False, NoEventMask, &event);
    XFlush(drag->display);
}

/* Answers the target's request for the list of files. */
static void answer(const struct drag *drag, const XSelectionRequestEvent *request)
{
    XEvent event = {.xselection = {.type = SelectionNotify,
                                   .requestor = request->requestor,
                                   .selection = request->selection,
                                   .target = request->target,
                                   .property = request->property,
                                   .time = request->time}};
    XChangeProperty(drag->display, request->requestor, request->property, request->target, 8,
                    PropModeReplace, (const unsigned char *)drag->uris, (int)strlen(drag->uris));
    XSendEvent(drag->display, request->requestor, False, NoEventMask, &event);
    XFlush(drag->display);
}

/* Answers requests until the target sends a message; its word 1 says whether it accepts. */
static int wait_for(const struct drag *drag, const char *type)
{
    const struct timespec pause = {.tv_nsec = 10000000};
    for (int tries = 0; tries < TRIES; tries++) {
        while (XPending(drag->display) > 0) {
            XEvent event;
            XNextEvent(drag->display, &event);
            if (event.type == SelectionRequest)
                answer(drag, &event.xselectionrequest);
            if (event.type == ClientMessage && event.xclient.message_type == atom(drag, type))
                return event.xclient.data.l[1] & 1;
        }
        nanosleep(&pause, NULL);
    }
    fprintf(stderr, "drop_files: no %s\n", type);
    return 0;
}

static int drop(const struct drag *drag)
{
    const long copy = (long)atom(drag, "XdndActionCopy");
    XSetSelectionOwner(drag->display, atom(drag, "XdndSelection"), drag->source, CurrentTime);
    send(drag, "XdndEnter",
         (const long[]){(long)VERSION << 24, (long)atom(drag, "text/uri-list"), 0, 0});
    send(drag, "XdndPosition", (const long[]){0, 100 << 16 | 100, CurrentTime, copy});
    if (!wait_for(drag, "XdndStatus"))
        return 0;
    send(drag, "XdndDrop", (const long[]){0, CurrentTime, 0, 0});
    return wait_for(drag, "XdndFinished");
}

int main(int argc, char **argv)
{
    struct drag drag = {.display = XOpenDisplay(NULL)};
    size_t length = 0;
    if (!drag.display || argc < 3)
        return EXIT_FAILURE;
    drag.target = strtoul(argv[1], NULL, 0);
    drag.source =
        XCreateSimpleWindow(drag.display, DefaultRootWindow(drag.display), 0, 0, 8, 8, 0, 0, 0);
    for (int i = 2; i < argc && length < sizeof drag.uris; i++)
        length += (size_t)snprintf(drag.uris + length, sizeof drag.uris - length, "file://%s\r\n",
                                   argv[i]);
    const int dropped = drop(&drag);
    XCloseDisplay(drag.display);
    return dropped ? EXIT_SUCCESS : EXIT_FAILURE;
}
