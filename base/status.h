/* Status: the one way in which every function of Weft reports failure.
 *
 * A function that can fail returns a weft_code and takes a weft_error as its last
 * argument. On failure it fills the error (once, at the place where the cause is known)
 * and returns the same code; callers forward it with WEFT_TRY. Nothing below `cli/`
 * prints. The codes are the exit codes of the program. */
#ifndef WEFT_BASE_STATUS_H
#define WEFT_BASE_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum weft_code {
    WEFT_OK = 0,
    WEFT_BAD_INPUT = 1, /* a file or its contents cannot be used */
    WEFT_BAD_USAGE = 2, /* the caller asked for something that makes no sense */
    WEFT_SYSTEM = 3     /* memory, disk, device or driver */
} weft_code;

enum { WEFT_MESSAGE_SIZE = 512 };

/* Owned by the caller, one per thread of control; zero-initialise it: {0}. */
typedef struct weft_error {
    weft_code code;
    char message[WEFT_MESSAGE_SIZE]; /* one line, no newline, names the file and the numbers */
} weft_error;

/* Fills `error` (which may be NULL) with a formatted one-line message. A message that is too long is cut; control
 * characters become '?'. Thread-safe. */
void weft_error_set(weft_error *error, weft_code code, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* weft_error_set with WEFT_SYSTEM and "cannot ACTION 'PATH': strerror(errno)". */
void weft_error_set_errno(weft_error *error, const char *action, const char *path);

/* Fills the error and has the value of `code`, for `return weft_fail(...)`. A macro, so that the compiler and the
 * analyser see that it is never WEFT_OK. */
#define weft_fail(error, code, ...) (weft_error_set(error, code, __VA_ARGS__), (code))

/* weft_fail with weft_error_set_errno. */
static inline weft_code weft_fail_errno(weft_error *error, const char *action, const char *path)
{
    weft_error_set_errno(error, action, path);
    return WEFT_SYSTEM;
}

/* weft_fail with WEFT_SYSTEM and "out of memory (WHAT, N bytes)". */
static inline weft_code weft_fail_memory(weft_error *error, const char *what, unsigned long long bytes)
{
    return weft_fail(error, WEFT_SYSTEM, "out of memory (%s, %llu bytes)", what, bytes);
}

/* Returns from the calling function with the code of `call` unless it is WEFT_OK. */
#define WEFT_TRY(call)                                                                                                 \
    do {                                                                                                               \
        weft_code try_code = (call);                                                                                   \
        if (try_code != WEFT_OK)                                                                                       \
            return try_code;                                                                                           \
    } while (0)

#ifdef __cplusplus
}
#endif
#endif
