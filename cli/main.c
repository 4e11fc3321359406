#include "cli/command.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct command {
    const char *heading; /* before it, or NULL */
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary;
} command;

static const command commands[] = {
    {"Photographs and geometry to a dataset:", "capture", command_capture,
     "photograph a sample under all views and lights"},
    {NULL, "simulate", command_simulate, "make a dataset of cloth from the geometry of its yarns"},
    {NULL, "register", command_register, "turn the photographs of a session into a dataset"},
    {NULL, "import", command_import, "turn foreign photographs into a dataset"},
    {NULL, "tile", command_tile, "average the repeats of a dataset into one tile"},
    {NULL, "bard", command_bard, "predict a dataset from the photographs under one light"},
    {"A dataset to a model:", "compress", command_compress, "fit lobes and a view table to a dataset"},
    {NULL, "fit-weave", command_fit_weave, "fit a weave to a dataset"},
    {"Look and measure:", "render", command_render, "draw a material to an image file"},
    {NULL, "play", command_play, "draw a material in a window"},
    {NULL, "compare", command_compare, "put dataset, material and analytic cloth side by side"},
    {NULL, "eval", command_eval, "evaluate any model at listed directions"},
    {NULL, "info", command_info, "say what a file holds"},
    {NULL, "verify", command_verify, "check a file from end to end"},
};

static void print_usage(FILE *stream)
{
    fputs("Example: weft compress silk.btf.h5 -o silk.weft\n\n"
          "Usage: weft COMMAND [OPTION...]\n"
          "Turns photographs of a material into something you can play back in real time.\n\n",
          stream);
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        if (commands[i].heading)
            fprintf(stream, "%s%s\n", i > 0 ? "\n" : "", commands[i].heading);
        fprintf(stream, "  %-10s %s\n", commands[i].name, commands[i].summary);
    }
    fputs("\n'weft COMMAND --help' explains a command. 'weft --version' prints the version.\n"
          "Exit codes: 0 done, 1 bad input, 2 bad usage, 3 device or system failure.\n",
          stream);
}

static int run_command(const command *chosen, int argc, char **argv)
{
    /* argp names the program by argv[0] in its messages: "weft NAME". */
    char name[64];
    snprintf(name, sizeof name, "weft %s", chosen->name);
    argv[0] = name;
    return chosen->run(argc, argv);
}

int main(int argc, char **argv)
{
    /* A file-size limit is then an error like a full disk, and a closed pipe an error of write(). */
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    if (argc < 2) {
        print_usage(stderr);
        return WEFT_BAD_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "help") == 0) {
        print_usage(stdout);
        return EXIT_SUCCESS;
    }
    if (strcmp(argv[1], "--version") == 0) {
        puts("weft " WEFT_VERSION);
        return EXIT_SUCCESS;
    }
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        if (strcmp(argv[1], commands[i].name) == 0)
            return run_command(&commands[i], argc - 1, argv + 1);
    }
    fprintf(stderr, "weft: there is no command '%s'; 'weft --help' lists them\n", argv[1]);
    return WEFT_BAD_USAGE;
}
