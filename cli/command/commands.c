#include "cli/command/command.h"

#include <string.h>

const weft_command_entry weft_commands[] = {
    {"Before photographs are taken by hand:", &weft_command_target},
    {NULL, &weft_command_lens},
    {NULL, &weft_command_colour},
    {"Photographs and geometry to a dataset:", &weft_command_capture},
    {NULL, &weft_command_calibrate},
    {NULL, &weft_command_synthetic},
    {NULL, &weft_command_simulate},
    {NULL, &weft_command_register},
    {NULL, &weft_command_photographs},
    {NULL, &weft_command_import},
    {NULL, &weft_command_tile},
    {NULL, &weft_command_relief},
    {NULL, &weft_command_bard},
    {"A dataset to a model:", &weft_command_compress},
    {NULL, &weft_command_prune},
    {NULL, &weft_command_fit_weave},
    {"Look and measure:", &weft_command_render},
    {NULL, &weft_command_play},
    {NULL, &weft_command_compare},
    {NULL, &weft_command_tradeoff},
    {NULL, &weft_command_truth},
    {NULL, &weft_command_eval},
    {NULL, &weft_command_info},
    {NULL, &weft_command_verify},
    {NULL, NULL},
};

static bool is_called(const weft_command *command, const char *name)
{
    return strcmp(command->name, name) == 0 || (command->former_name && strcmp(command->former_name, name) == 0);
}

const weft_command *weft_command_named(const char *name)
{
    const weft_command_entry *entry = weft_commands;
    while (entry->command && !is_called(entry->command, name))
        entry++;
    return entry->command;
}
