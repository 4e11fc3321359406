#include "cli/command/arguments.h"
#include "cli/command/command.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_usage(FILE *stream)
{
    fputs("Example: weft compress silk.btf.h5 -o silk.weft\n\n"
          "Usage: weft COMMAND [OPTION...]\n"
          "Turns photographs of a material into something you can play back in real time.\n\n",
          stream);
    for (const weft_command_entry *entry = weft_commands; entry->command; entry++) {
        if (entry->heading)
            fprintf(stream, "%s%s\n", entry > weft_commands ? "\n" : "", entry->heading);
        fprintf(stream, "  %-12s %s\n", entry->command->name, entry->command->summary);
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
    if (strcmp(argv[1], "--complete") == 0)
        return weft_complete(argc - 2, argv + 2);
    const weft_command *chosen = weft_command_named(argv[1]);
    if (chosen && strcmp(argv[1], chosen->name) != 0)
        fprintf(stderr, "weft: '%s' is now called '%s'\n", chosen->former_name, chosen->name);
    if (chosen)
        return run_command(chosen, argc - 1, argv + 1);
    fprintf(stderr, "weft: there is no command '%s'; 'weft --help' lists them\n", argv[1]);
    return WEFT_BAD_USAGE;
}
