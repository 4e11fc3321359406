/* How a long computation tells its caller how far it is. */
#ifndef WEFT_BASE_PROGRESS_H
#define WEFT_BASE_PROGRESS_H

/* `report` may be NULL. It is called from one thread at a time, with 0 <= done <= total; `stage` is a present
 * participle in lower case ("registering views") that stays the same for the whole of a stage; it is the caller's, to
 * be read during the call alone. */
typedef struct weft_progress {
    void (*report)(void *context, const char *stage, long done, long total);
    void *context;
} weft_progress;

static inline void weft_progress_report(const weft_progress *progress, const char *stage, long done, long total)
{
    if (progress && progress->report)
        progress->report(progress->context, stage, done, total);
}

/* How a long computation tells its caller something that is no error and cannot wait for the end. `line` may be NULL;
 * `text` is one line without a newline, the caller's, to be read during the call alone. */
typedef struct weft_log {
    void (*line)(void *context, const char *text);
    void *context;
} weft_log;

static inline void weft_log_line(const weft_log *log, const char *text)
{
    if (log->line)
        log->line(log->context, text);
}

#endif
