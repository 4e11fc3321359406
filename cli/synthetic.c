#include "capture/synthetic/synthetic.h"
#include "cli/command/arguments.h"

#include <stdlib.h>

typedef struct synthetic_command {
    weft_common_options common;
    weft_synthetic_request request;
} synthetic_command;

static const char *const set_names[] = {"free", "flash", "tripod", "stepped", NULL};
static const char *const format_names[] = {"jpeg", "tiff", "exr", NULL};
static const char *const curve_names[] = {"contrast", "soft", NULL};

#define PLACE(field) offsetof(synthetic_command, request.field)

static const weft_option option_table[] = {
    {.argument = "CLOTH", .is_required = true, .kind = WEFT_OPTION_INPUT, .offset = PLACE(content)},
    {"output", 'o', "FOLDER", "The folder for the photographs, empty or new", .is_required = true,
     .kind = WEFT_OPTION_FOLDER, .offset = PLACE(folder)},
    {"set", .argument = "WHICH",
     .help =
         "How they are taken: free (default; camera and lamp in the hands), flash (on the camera), tripod (the lamp "
         "moves) or stepped (turntable and arms)",
     .kind = WEFT_OPTION_CHOICE, .offset = PLACE(set), .words = set_names},
    {"photographs", .argument = "N", .help = "How many (default: 60)", .kind = WEFT_OPTION_WHOLE,
     .offset = PLACE(photograph_count), .low = 1, .high = 5000},
    {"rubbish", .argument = "N", .help = "Number of unusable photographs (default: 0)", .kind = WEFT_OPTION_WHOLE,
     .offset = PLACE(rubbish_count), .low = 0, .high = 5000},
    {"series", .argument = "N",
     .help = "Number of views that are photographed twice, the second time two stops darker (default: 0)",
     .kind = WEFT_OPTION_WHOLE, .offset = PLACE(series_count), .low = 0, .high = 2500},
    {"seed", .argument = "N", .help = "Start of the random numbers (default: 1)", .kind = WEFT_OPTION_SEED,
     .offset = PLACE(seed)},
    {"format", .argument = "FORMAT", .help = "jpeg (default), tiff (16 bits, linear) or exr (half floats, linear)",
     .kind = WEFT_OPTION_CHOICE, .offset = PLACE(format), .words = format_names},
    {"curve", .argument = "WHICH",
     .help = "Tone curve of jpeg: contrast (default; darker than sRGB in the dark) or soft (brighter)",
     .kind = WEFT_OPTION_CHOICE, .offset = PLACE(curve), .words = curve_names},
    {"width", .argument = "N", .help = "Pixels across; the height is two thirds (default: 3000)",
     .kind = WEFT_OPTION_WHOLE, .offset = PLACE(width), .low = 300, .high = 8000},
    {"opening", .argument = "MM", .help = "Side of the opening of the printed sheet (default: 50)",
     .kind = WEFT_OPTION_NUMBER, .offset = PLACE(opening_mm), .low = 20, .high = 200},
    {"focal-length", .argument = "MM", .help = "Focal length of the lens, on an APS-C sensor (default: 35)",
     .kind = WEFT_OPTION_NUMBER, .offset = PLACE(focal_length_mm), .low = 18, .high = 120},
    {"max-view", .argument = "DEGREES", .help = "Steepest view, in degrees from the normal (default: 65)",
     .kind = WEFT_OPTION_ANGLE, .offset = PLACE(max_view_rad), .low = 0, .high = 80},
    {"lamp-radius", .argument = "MM", .help = "Half the size of the lamp (default: 12)", .kind = WEFT_OPTION_NUMBER,
     .offset = PLACE(lamp_radius_mm), .low = 0.1, .high = 100},
    {"hand-shadows", .argument = "PERCENT",
     .help = "Share of the photographs in which a hand shades the sheet (default: 0)", .kind = WEFT_OPTION_NUMBER,
     .offset = PLACE(hand_shadows), .low = 0, .high = 100, .divisor = 100},
    {"gloss", .argument = "PERCENT", .help = "Share of light that paper and ink reflect as a highlight (default: 0)",
     .kind = WEFT_OPTION_NUMBER, .offset = PLACE(gloss), .low = 0, .high = 20, .divisor = 100},
    {"window", .argument = "LUMINANCE", .help = "Luminance of the window of the dark room, in cd/m^2 (default: 100)",
     .kind = WEFT_OPTION_NUMBER, .offset = PLACE(window), .low = 0, .high = 10000},
    {"white-balance", .argument = "PERCENT", .help = "Change of the gains of red and blue (default: 0)",
     .kind = WEFT_OPTION_NUMBER, .offset = PLACE(white_balance), .low = 0, .high = 20, .divisor = 100},
    {"breathing", .argument = "PERCENT", .help = "Focus breathing, as a share of that of a simple lens (default: 0)",
     .kind = WEFT_OPTION_NUMBER, .offset = PLACE(breathing), .low = 0, .high = 100, .divisor = 100},
    {"no-balls", .help = "Without the mirror balls", .kind = WEFT_OPTION_FLAG, .offset = PLACE(no_balls)},
    {"no-pin", .help = "Without the pin", .kind = WEFT_OPTION_FLAG, .offset = PLACE(no_pin)},
    {"truth-size", .argument = "N", .help = "Texels along a side of the true reflectance; 0: none (default: 64)",
     .kind = WEFT_OPTION_WHOLE, .offset = PLACE(truth_size), .low = 0, .high = 4096},
    {0},
};

static weft_code check(void *values, weft_error *error)
{
    const weft_synthetic_request *request = &((const synthetic_command *)values)->request;
    if (request->rubbish_count >= request->photograph_count)
        return weft_fail(error, WEFT_BAD_USAGE, "--rubbish %d leaves no photograph of %d", request->rubbish_count,
                         request->photograph_count);
    if (2 * request->series_count > request->photograph_count)
        return weft_fail(error, WEFT_BAD_USAGE, "--series %d takes %d photographs, there are %d", request->series_count,
                         2 * request->series_count, request->photograph_count);
    return WEFT_OK;
}

static int run(int argc, char **argv)
{
    synthetic_command command = {.request = weft_synthetic_request_default()};
    char warning[WEFT_MESSAGE_SIZE] = "";
    weft_error error = {0};
    weft_arguments_parse(&weft_command_synthetic, argc, argv, &command);
    weft_progress progress = weft_command_progress(&command.common);
    weft_code code = weft_synthetic_run(&command.request, &progress, warning, &error);
    if (warning[0])
        weft_command_say(&command.common, "%s", warning);
    if (code == WEFT_OK)
        weft_command_say(&command.common, "%s: %d photographs", command.request.folder,
                         command.request.photograph_count);
    return weft_command_exit("synthetic", &command.common, code, &error);
}

const weft_command weft_command_synthetic = {
    .name = "synthetic",
    .former_name = "hand",
    .summary = "make synthetic photographs of a printed sheet, with known truth",
    .usage = "CLOTH -o FOLDER",
    .documentation =
        "Example: weft synthetic assets/weaves/silk_charmeuse.wv -o silk/\n\n"
        "Traces photographs of a cloth in the opening of the printed sheet, as a camera, a lamp, two mirror balls and "
        "a "
        "pin would give them. The true geometry and reflectance go to FOLDER.truth.json and FOLDER.truth.btf.h5, "
        "beside the folder. CLOTH is a weave, a stitch, or the word checker: patches whose reflectance is a formula.",
    .options = option_table,
    .needs = "CLOTH.wv, CLOTH.stitch or checker, and -o FOLDER",
    .surplus = "one cloth at a time",
    .check = check,
    .run = run,
};
