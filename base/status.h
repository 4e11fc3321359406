/* How the library fills the error of weft/status.h: once, at the place where the cause is known. Callers forward the
 * code with WEFT_TRY. Nothing below `cli/` prints. */
#ifndef WEFT_BASE_STATUS_H
#define WEFT_BASE_STATUS_H

#include "weft/status.h"

#include <errno.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Fills `error` (which may be NULL) with a formatted one-line message. A message that is too long is cut; control
 * characters become '?'. Thread-safe. */
void weft_error_set(weft_error *error, weft_code code, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* weft_error_set with weft_code_of_errno and "cannot ACTION 'PATH': strerror(errno)". */
void weft_error_set_errno(weft_error *error, const char *action, const char *path);

/* WEFT_OUT_OF_MEMORY where errno is ENOMEM, else WEFT_SYSTEM. */
static inline weft_code weft_code_of_errno(void)
{
    return errno == ENOMEM ? WEFT_OUT_OF_MEMORY : WEFT_SYSTEM;
}

/* Fills the error and has the value of `code`, for `return weft_fail(...)`. A macro, so that the compiler and the
 * analyser see that it is never WEFT_OK. */
#define weft_fail(error, code, ...) (weft_error_set(error, code, __VA_ARGS__), (code))

/* weft_fail with weft_error_set_errno. */
static inline weft_code weft_fail_errno(weft_error *error, const char *action, const char *path)
{
    weft_code code = weft_code_of_errno();
    weft_error_set_errno(error, action, path);
    return code;
}

/* weft_fail with WEFT_OUT_OF_MEMORY and "out of memory (WHAT, N bytes)". */
static inline weft_code weft_fail_memory(weft_error *error, const char *what, unsigned long long bytes)
{
    return weft_fail(error, WEFT_OUT_OF_MEMORY, "out of memory (%s, %llu bytes)", what, bytes);
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
