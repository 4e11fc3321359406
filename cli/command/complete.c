#include "cli/command/arguments.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { MOST_MEANING = 60 };

static bool begins(const char *text, const char *start)
{
    return strncmp(text, start, strlen(start)) == 0;
}

/* Up to the first stop, semicolon or bracket, or some words. */
static void print_help(const char *help)
{
    size_t length = strcspn(help, ".;(:\n");
    if (length > MOST_MEANING)
        for (length = MOST_MEANING; length > 0 && help[length] != ' ';)
            length--;
    while (length > 0 && help[length - 1] == ' ')
        length--;
    printf("\t%.*s\n", (int)length, help);
}

static void print_commands(const char *start)
{
    for (const weft_command_entry *entry = weft_commands; entry->command; entry++) {
        if (begins(entry->command->name, start))
            printf("%s\t%s\n", entry->command->name, entry->command->summary);
    }
    if (begins("--help", start))
        puts("--help\tlist the commands");
    if (begins("--version", start))
        puts("--version\tprint the version");
}

/* ---- What an option or an argument takes ---- */

static bool is_placeholder(const char *part, size_t length)
{
    for (size_t i = 0; i < length && part[i] != '.'; i++)
        if (islower((unsigned char)part[i]) || isdigit((unsigned char)part[i]))
            return false;
    return true;
}

/* "pca:K" begins with "pca:"; a range, "0..3", is no word. */
static size_t fixed_length(const char *part, size_t length)
{
    if (memmem(part, length, "..", 2))
        return 0;
    while (length > 0 && isupper((unsigned char)part[length - 1]))
        length--;
    return length;
}

/* "NAME.weft" is a file, "DIR" a folder, "on" itself; the other words in capitals are numbers or a user's own names. */
static void print_part(const weft_option *option, const char *part, size_t length, const char *before,
                       const char *start)
{
    const char *ending = memchr(part, '.', length);
    if (!is_placeholder(part, length)) {
        length = fixed_length(part, length);
        if (length > 0 && length >= strlen(start) && begins(part, start))
            printf("%s%.*s\t\n", before, (int)length, part);
    } else if (option->kind == WEFT_OPTION_FOLDER || begins(part, "FOLDER") || begins(part, "SESSION"))
        puts(":folder");
    else if (ending)
        printf(":file\t%.*s\n", (int)(part + length - ending), ending);
    else if (option->kind == WEFT_OPTION_INPUT || option->kind == WEFT_OPTION_OUTPUT || !option->name ||
             begins(part, "FILE"))
        puts(":file");
}

static void print_values(const weft_option *option, const char *before, const char *start)
{
    if (option->words) {
        for (const char *const *word = option->words; *word; word++)
            if (begins(*word, start))
                printf("%s%s\t\n", before, *word);
        return;
    }
    for (const char *part = option->argument; part;) {
        size_t length = strcspn(part, "|");
        print_part(option, part, length, before, start);
        part = part[length] ? part + length + 1 : NULL;
    }
}

/* ---- What is on the line ---- */

/* An option by its name or letter. */
typedef struct option_search {
    const char *name;
    char letter;
    const weft_option *found;
} option_search;

static void compare_option(void *context, const weft_option *option, const weft_setting *setting)
{
    option_search *search = context;
    (void)setting;
    bool is_named = search->name && option->name && strcmp(option->name, search->name) == 0;
    if ((is_named || (search->letter && option->letter == search->letter)) && option->argument)
        search->found = option;
}

/* The option with a value that the word names, or NULL. */
static const weft_option *option_of(const weft_command *command, const char *word)
{
    option_search search = {0};
    if (begins(word, "--"))
        search.name = word + 2;
    else if (word[0] == '-' && word[1] && !word[2])
        search.letter = word[1];
    weft_arguments_each(command, compare_option, &search);
    return search.found;
}

/* That option, where its value must stand in the next word. */
static const weft_option *option_before(const weft_command *command, const char *word)
{
    const weft_option *option = option_of(command, word);
    return option && !option->may_be_empty ? option : NULL;
}

/* The option whose value the last word is, where the shell has cut it at "=" or not; NULL: of none. */
static const weft_option *option_asked(const weft_command *command, int count, char **word)
{
    if (count > 1 && strcmp(word[count - 1], "=") == 0)
        return option_of(command, word[count - 2]);
    if (count > 2 && strcmp(word[count - 2], "=") == 0)
        return option_of(command, word[count - 3]);
    return count > 1 ? option_before(command, word[count - 2]) : NULL;
}

static void complete_joined(const weft_command *command, const char *word, const char *equals)
{
    char name[80], before[88];
    snprintf(name, sizeof name, "%.*s", (int)(equals - word), word);
    snprintf(before, sizeof before, "%s=", name);
    const weft_option *option = option_of(command, name);
    if (option)
        print_values(option, before, equals + 1);
}

static void print_option(void *context, const weft_option *option, const weft_setting *setting)
{
    const char *start = context;
    (void)setting;
    char name[80];
    if (!option->name || option->gone)
        return;
    snprintf(name, sizeof name, "--%s", option->name);
    if (begins(name, start)) {
        fputs(name, stdout);
        print_help(option->help);
    }
}

/* Arguments that are known by their place: how many stand before, and how many have been visited. */
typedef struct place_search {
    int before, visited;
    const char *start;
} place_search;

static void print_place(void *context, const weft_option *option, const weft_setting *setting)
{
    place_search *search = context;
    (void)setting;
    if (option->name)
        return;
    if (search->visited == search->before || (search->visited < search->before && option->repeats))
        print_values(option, "", search->start);
    search->visited++;
}

static int count_places(const weft_command *command, int count, char **word)
{
    int places = 0;
    for (int i = 0; i < count; i++) {
        bool is_cut = strcmp(word[i], "=") == 0 || (i > 0 && strcmp(word[i - 1], "=") == 0);
        places += word[i][0] != '-' && !is_cut && !(i > 0 && option_before(command, word[i - 1]));
    }
    return places;
}

/* The words after the command. */
static void complete_in(const weft_command *command, int count, char **word)
{
    char *current = word[count - 1];
    const char *equals = begins(current, "--") ? strchr(current, '=') : NULL;
    const weft_option *option = option_asked(command, count, word);
    if (equals)
        complete_joined(command, current, equals);
    else if (option)
        print_values(option, "", strcmp(current, "=") == 0 ? "" : current);
    else if (current[0] == '-') {
        weft_arguments_each(command, print_option, current);
        if (begins("--help", current))
            puts("--help\texplain the command");
    } else {
        place_search search = {count_places(command, count - 1, word), 0, current};
        weft_arguments_each(command, print_place, &search);
    }
}

int weft_complete(int count, char **word)
{
    if (count <= 1)
        print_commands(count == 1 ? word[0] : "");
    else {
        const weft_command *command = weft_command_named(word[0]);
        if (command)
            complete_in(command, count - 1, word + 1);
    }
    return 0;
}
