/* How a computation tells its caller something that is no error and cannot wait for the end. */
#ifndef WEFT_COMPRESS_RUN_NOTE_H
#define WEFT_COMPRESS_RUN_NOTE_H

/* `tell` may be NULL; `text` is one line without a newline. */
typedef struct weft_note {
    void (*tell)(void *context, const char *text);
    void *context;
} weft_note;

#endif
