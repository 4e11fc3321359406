/* Status: how every function of Weft reports failure.
 *
 * A function that can fail returns a weft_code and takes a weft_error as its last argument, which may be NULL. On
 * failure it fills the error and returns the same code, and nothing is left for the caller to free. The library prints
 * nothing. */
#ifndef WEFT_STATUS_H
#define WEFT_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

/* Marks what the shared library exports: the functions of include/weft. */
#define WEFT_API __attribute__((visibility("default")))

/* Three classes of failure, which are the exit codes of the program, and finer codes beneath them. A function returns a
 * finer code where it knows the cause, else the class. Where a comment says "Errors: WEFT_BAD_INPUT", it means each
 * code of that class. Later versions may add finer codes: compare with weft_class_of where the class matters. */
typedef enum weft_code {
    WEFT_OK = 0,

    WEFT_BAD_INPUT = 1,        /* class: a file or its contents cannot be used */
    WEFT_MISSING = 0x11,       /* there is no such file */
    WEFT_DAMAGED = 0x21,       /* a file is cut short, contradicts itself or fails its checksum */
    WEFT_NOT_SUPPORTED = 0x31, /* a file of a newer version, or with a feature that this version does not know */

    WEFT_BAD_USAGE = 2, /* class: the caller asked for something that makes no sense */

    WEFT_SYSTEM = 3,          /* class: disk, device or driver */
    WEFT_OUT_OF_MEMORY = 0x13 /* too little memory */
} weft_code;

/* The class of a code: WEFT_OK, WEFT_BAD_INPUT, WEFT_BAD_USAGE or WEFT_SYSTEM. Pure. */
static inline weft_code weft_class_of(weft_code code)
{
    return (weft_code)((unsigned)code & 0xf);
}

enum { WEFT_MESSAGE_SIZE = 512 };

/* Owned by the caller, one for each thread; zero-initialise it: {0}. Functions write to it only when they fail. */
typedef struct weft_error {
    weft_code code;
    char message[WEFT_MESSAGE_SIZE]; /* one line, no newline, names the file and the numbers; UTF-8 */
} weft_error;

#ifdef __cplusplus
}
#endif
#endif
