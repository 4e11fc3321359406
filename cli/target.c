#include "capture/print/page.h"
#include "capture/print/sheets.h"
#include "cli/command/arguments.h"

typedef struct target_command {
    weft_common_options common;
    const char *output;
    double opening_mm, ball_mm, pin_mm; /* opening 0, others below 0: not given */
    bool board;
    weft_paper paper;
    weft_target_sheet_settings sheet; /* as checked */
    weft_lens_board lens_board;
} target_command;

static const double default_ball_mm = 20, default_pin_mm = 30, smallest_mm = 3;

static weft_code read_paper(const weft_option *option, const char *text, void *target, weft_error *error)
{
    (void)option;
    return weft_paper_parse(text, &((target_command *)target)->paper, error);
}

static const weft_option option_table[] = {
    {"output", 'o', "NAME.pdf|NAME.svg", "The page to write", .is_required = true, .kind = WEFT_OPTION_OUTPUT,
     .offset = offsetof(target_command, output)},
    {"paper", .argument = "SIZE", .help = "A4 (default), A3, A5, letter, legal, tabloid, or WxH in mm",
     .kind = WEFT_OPTION_OTHER, .read = read_paper},
    {"opening", .argument = "MM",
     .help = "Side of the square that shows the sample (default: 50, or the largest that fits the paper)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(target_command, opening_mm), .low = 20, .high = 1000},
    {"balls", .argument = "MM", .help = "Diameter of the mirror balls; 0: there are none (default: 20)",
     .kind = WEFT_OPTION_NUMBER, .offset = offsetof(target_command, ball_mm), .low = 0, .high = 200,
     .former_name = "ball"},
    {"pin", .argument = "MM", .help = "Height of the pin; 0: there is none (default: 30)", .kind = WEFT_OPTION_NUMBER,
     .offset = offsetof(target_command, pin_mm), .low = 0, .high = 200},
    {"board", .help = "Print a board for 'weft lens' instead", .kind = WEFT_OPTION_FLAG,
     .offset = offsetof(target_command, board)},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    target_command *command = values;
    WEFT_TRY(weft_print_page_check_name(command->output, error));
    if (command->board && (command->opening_mm > 0 || command->ball_mm >= 0 || command->pin_mm >= 0))
        return weft_fail(error, WEFT_BAD_USAGE, "--board has no opening, no balls and no pin");
    if (command->board)
        return weft_lens_board_for(&command->paper, &command->lens_board, error);
    command->sheet = (weft_target_sheet_settings){command->paper, command->opening_mm,
                                                  command->ball_mm >= 0 ? command->ball_mm : default_ball_mm,
                                                  command->pin_mm >= 0 ? command->pin_mm : default_pin_mm};
    if ((command->sheet.ball_mm > 0 && command->sheet.ball_mm < smallest_mm) ||
        (command->sheet.pin_mm > 0 && command->sheet.pin_mm < smallest_mm))
        return weft_fail(error, WEFT_BAD_USAGE, "balls and pin are 0 (none) or %g mm and more", smallest_mm);
    return weft_target_sheet_check(&command->sheet, error);
}

static void report_page(const target_command *command)
{
    const weft_common_options *common = &command->common;
    if (command->board)
        weft_command_say(common, "%s: lens board on %s, for weft lens --board %s", command->output, command->paper.name,
                         command->lens_board.text);
    else
        weft_command_say(common, "%s: target on %s, opening %.4g mm, balls of %g mm, pin of %g mm%s", command->output,
                         command->paper.name, command->sheet.opening_mm, command->sheet.ball_mm, command->sheet.pin_mm,
                         command->sheet.ball_mm > 0 && command->sheet.pin_mm > 0 ? "" : " (0: none)");
    weft_command_say(common, "print it at 100 %% on matt paper, and measure the bar");
}

static int run(int argc, char **argv)
{
    target_command command = {.ball_mm = -1, .pin_mm = -1};
    weft_error error = {0};
    weft_code code = weft_paper_parse("A4", &command.paper, &error);
    weft_arguments_parse(&weft_command_target, argc, argv, &command);
    if (code == WEFT_OK)
        code = command.board ? weft_lens_board_print(&command.lens_board, command.output, &error)
                             : weft_target_sheet_print(&command.sheet, command.output, &error);
    if (code == WEFT_OK)
        report_page(&command);
    return weft_command_exit("target", &command.common, code, &error);
}

const weft_command weft_command_target = {
    .name = "target",
    .summary = "print the target, or a board for a lens, at true size",
    .usage = "-o NAME.pdf|NAME.svg",
    .documentation =
        "Example: weft target -o target.pdf --paper A4\n\n"
        "Draws the sheet that is photographed with the sample: markers round a square opening, places for two "
        "mirror balls and a pin, and bars to measure after printing. With --board, draws a board for 'weft "
        "lens'.",
    .options = option_table,
    .needs = "-o NAME.pdf or NAME.svg",
    .surplus = "nothing is read",
    .check = check,
    .run = run,
};
