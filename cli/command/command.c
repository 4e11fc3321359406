#include "cli/command/command.h"
#include "base/clock.h"
#include "base/text/json_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What the reporter remembers between calls; one command runs per process. */
static struct {
    char stage[64];
    double started_s, shown_s;
    bool line_open; /* the terminal's cursor stands behind an unfinished line */
} shown;

static void close_line(void)
{
    if (shown.line_open)
        fputc('\n', stderr);
    shown.line_open = false;
}

void weft_command_event(const weft_common_options *common, const char *json_object)
{
    if (common->json && !common->quiet) {
        puts(json_object);
        fflush(stdout);
    }
}

void weft_command_say_lines(const weft_common_options *common, const char *before, const weft_lines *lines)
{
    for (int i = 0; i < lines->count; i++)
        weft_command_say(common, "%s%s", before, lines->line[i]);
}

const char *weft_command_number(double value, char text[WEFT_NUMBER_SIZE])
{
    snprintf(text, WEFT_NUMBER_SIZE, isfinite(value) ? "%.6g" : "null", value);
    return text;
}

static void show_event(const char *stage, long done, long total)
{
    printf("{\"event\":\"progress\",\"stage\":\"%s\",\"done\":%ld,\"total\":%ld}\n", stage, done, total);
    fflush(stdout);
}

static void show_line(const char *stage, long done, long total, double elapsed_s, bool terminal)
{
    fprintf(stderr, "%s%s %ld of %ld", terminal ? "\r" : "", stage, done, total);
    if (done >= total)
        fprintf(stderr, ", %.1f s%s", elapsed_s, terminal ? "     \n" : "\n");
    else if (done > 0)
        fprintf(stderr, ", %.0f s to go%s", elapsed_s * (double)(total - done) / (double)done, terminal ? "   " : "\n");
    else if (!terminal)
        fputc('\n', stderr);
    shown.line_open = terminal && done < total;
    fflush(stderr);
}

static void report_progress(void *context, const char *stage, long done, long total)
{
    const weft_common_options *common = context;
    if (common->quiet)
        return;
    bool terminal = !common->json && isatty(STDERR_FILENO);
    double now = weft_now_s(), interval_s = terminal ? 0.1 : 5;
    bool new_stage = strncmp(stage, shown.stage, sizeof shown.stage - 1) != 0;
    if (new_stage) {
        close_line();
        snprintf(shown.stage, sizeof shown.stage, "%s", stage);
        shown.started_s = now;
    }
    if (!new_stage && done < total && now - shown.shown_s < interval_s)
        return;
    shown.shown_s = now;
    if (common->json)
        show_event(stage, done, total);
    else
        show_line(stage, done, total, now - shown.started_s, terminal);
}

weft_progress weft_command_progress(const weft_common_options *common)
{
    return (weft_progress){report_progress, (void *)common};
}

/* Prints and frees an event. */
static void print_event(json_t *event)
{
    char *line = event ? json_dumps(event, JSON_COMPACT) : NULL;
    if (line)
        puts(line);
    free(line);
    json_decref(event);
}

void weft_command_say(const weft_common_options *common, const char *format, ...)
{
    if (common->quiet)
        return;
    char text[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    close_line();
    if (common->json)
        print_event(json_pack("{ss so}", "event", "note", "text", weft_json_text(text, strlen(text))));
    else
        puts(text);
    fflush(stdout);
}

void weft_command_say_page(const weft_common_options *common, const char *name, const char *folder)
{
    bool ends_in_slash = *folder && folder[strlen(folder) - 1] == '/';
    weft_command_say(common, "%s: %s%sindex.html", name, folder, ends_in_slash ? "" : "/");
}

static void say_line(void *context, const char *text)
{
    weft_command_say(context, "%s", text);
}

weft_log weft_command_log(const weft_common_options *common)
{
    return (weft_log){say_line, (void *)common};
}

int weft_command_exit(const char *command, const weft_common_options *common, weft_code code, const weft_error *error)
{
    close_line();
    if (code == WEFT_OK)
        return WEFT_OK;
    fprintf(stderr, "weft %s: %s\n", command, error->message);
    if (common->json && !common->quiet)
        print_event(json_pack("{ss si so}", "event", "error", "code", (int)weft_class_of(code), "text",
                              weft_json_text(error->message, strlen(error->message))));
    return (int)weft_class_of(code);
}
