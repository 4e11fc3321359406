#include "cli/command.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Commands with the heading before them, or NULL. */
static const struct {
    const char *heading;
    const weft_command *command;
} commands[] = {
    {"Before photographs are taken by hand:", &weft_command_target},
    {NULL, &weft_command_lens},
    {"Photographs and geometry to a dataset:", &weft_command_capture},
    {NULL, &weft_command_hand},
    {NULL, &weft_command_simulate},
    {NULL, &weft_command_register},
    {NULL, &weft_command_photographs},
    {NULL, &weft_command_import},
    {NULL, &weft_command_tile},
    {NULL, &weft_command_relief},
    {NULL, &weft_command_bard},
    {"A dataset to a model:", &weft_command_compress},
    {NULL, &weft_command_fit_weave},
    {"Look and measure:", &weft_command_render},
    {NULL, &weft_command_play},
    {NULL, &weft_command_compare},
    {NULL, &weft_command_eval},
    {NULL, &weft_command_info},
    {NULL, &weft_command_verify},
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
        fprintf(stream, "  %-10s %s\n", commands[i].command->name, commands[i].command->summary);
    }
    fputs("\n'weft COMMAND --help' explains a command. 'weft --version' prints the version.\n"
          "Exit codes: 0 done, 1 bad input, 2 bad usage, 3 device or system failure.\n",
          stream);
}

static int run_command(const weft_command *chosen, int argc, char **argv)
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
        if (strcmp(argv[1], commands[i].command->name) == 0)
            return run_command(commands[i].command, argc - 1, argv + 1);
    }
    fprintf(stderr, "weft: there is no command '%s'; 'weft --help' lists them\n", argv[1]);
    return WEFT_BAD_USAGE;
}
