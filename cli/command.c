#include "cli/command.h"
#include "base/clock.h"
#include "base/json_text.h"
#include "cli/arguments.h"

#include <limits.h>
#include <omp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *argp_program_version = "weft " WEFT_VERSION;

/* ---- Common options ---- */

enum { KEY_JSON = 0x1000 };

static const struct argp_option common_table[] = {
    {"quiet", 'q', 0, 0, "Print nothing but errors", 0},
    {"json", KEY_JSON, 0, 0, "Print progress and results as JSON, one event a line", 0},
    {"threads", 't', "N", 0, "Use N threads (default: all cores)", 0},
    {0},
};

static error_t parse_common(int key, char *argument, struct argp_state *state)
{
    common_options *options = state->input;
    switch (key) {
    case 'q':
        options->quiet = true;
        return 0;
    case KEY_JSON:
        options->json = true;
        return 0;
    case 't':
        options->threads = (int)parse_whole("threads", argument, 1, 4096, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp common_argp = {common_table, parse_common, NULL, NULL, NULL, NULL, NULL};

void command_parse(const struct argp *parser, int argc, char **argv, void *input, common_options *common)
{
    argp_err_exit_status = WEFT_BAD_USAGE;
    argp_parse(parser, argc, argv, 0, NULL, input);
    if (common->threads > 0)
        omp_set_num_threads(common->threads);
}

/* ---- One file of another ---- */

error_t parse_conversion(int key, char *argument, struct argp_state *state, conversion *files)
{
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &files->common;
        return 0;
    case 'o':
        files->output = argument;
        return 0;
    case ARGP_KEY_ARG:
        if (files->input)
            argp_error(state, "one %s at a time: '%s' is one too many", files->noun, argument);
        files->input = argument;
        return 0;
    case ARGP_KEY_END:
        if (files->needed && (!files->input || !files->output))
            argp_error(state, "needs %s", files->needed);
        refuse_same_file(files->output, files->input, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

/* ---- Speaking ---- */

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

void command_event(const common_options *common, const char *json_object)
{
    if (common->json && !common->quiet) {
        puts(json_object);
        fflush(stdout);
    }
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
    const common_options *common = context;
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

weft_progress command_progress(const common_options *common)
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

void command_say(const common_options *common, const char *format, ...)
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

int command_exit(const char *command, const common_options *common, weft_code code, const weft_error *error)
{
    close_line();
    if (code == WEFT_OK)
        return WEFT_OK;
    fprintf(stderr, "weft %s: %s\n", command, error->message);
    if (common->json && !common->quiet)
        print_event(json_pack("{ss si so}", "event", "error", "code", (int)code, "text",
                              weft_json_text(error->message, strlen(error->message))));
    return (int)code;
}
