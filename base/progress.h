/* Calls of the functions in weft/progress.h, where there are any. */
#ifndef WEFT_BASE_PROGRESS_H
#define WEFT_BASE_PROGRESS_H

#include "weft/progress.h"

static inline void weft_progress_report(const weft_progress *progress, const char *stage, long done, long total)
{
    if (progress && progress->report)
        progress->report(progress->context, stage, done, total);
}

static inline void weft_log_line(const weft_log *log, const char *text)
{
    if (log->line)
        log->line(log->context, text);
}

#endif
