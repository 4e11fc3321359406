#include "cli/scene_options.h"

#include "cli/arguments.h"
#include "cli/scene_values.h"

#include <stdlib.h>
#include <string.h>

static const struct argp_option option_table[] = {
    {0, 0, 0, 0, "What is shown:", 1},
    {"settings", KEY_SETTINGS, "PICTURE", 0,
     "Start from the settings in a picture of Weft's, or in a .json file; other options change them", 1},
    {"raw", KEY_RAW, "NAME.btf.h5", 0, "Show this dataset in mode raw", 1},
    {"raw-format", KEY_RAW_FORMAT, "auto|half|rgb9e5|bc6h", 0,
     "Keep its samples as half floats (8 bytes), with a shared exponent (4) or in compressed blocks (1); auto: the "
     "best "
     "that fits",
     1},
    {"weave", KEY_WEAVE, "CLOTH.wv|CLOTH.mc", 0, "Show this weave or microcylinder cloth in mode analytic", 1},
    {"tiles", KEY_TILES, "X,Y", 0,
     "Tiles of a .wv across the material (default: as its file says, else as the virtual rig lays it)", 1},
    {"mode", KEY_MODE, "MODE[,MODE...]", 0, "raw, compressed, analytic: one pane each; split: all that are given", 1},
    {"layout", KEY_LAYOUT, "LAYOUT", 0,
     "panes (default): side by side; wipe: first mode left of the divider, second right; difference: second - first",
     1},
    {"divider", KEY_DIVIDER, "X", 0, "Where a wipe changes, 0 (left) to 1 (default: 0.5)", 1},
    {0, 0, 0, 0, "Mesh and camera:", 2},
    {"mesh", KEY_MESH, "MESH", 0, "drape (default), sphere, plane, or an OBJ file with texture coordinates", 2},
    {"mesh-size", KEY_MESH_SIZE, "MM", 0,
     "Side of the plane or of the draped cloth, diameter of the sphere, longest side of an OBJ file (default: 300; the "
     "plane: as large as the material)",
     2},
    {"mesh-unit", KEY_MESH_UNIT, "mm|cm|m", 0, "Unit of an OBJ file, instead of --mesh-size", 2},
    {"repeat", KEY_REPEAT, "N", 0,
     "Materials across one unit of texture coordinates (default: so many that the cloth has its real size)", 2},
    {"camera", KEY_CAMERA, "AZIMUTH,ELEVATION,DISTANCE", 0,
     "Place of the camera in degrees and radii of the mesh (default: -70,28,3.6; plane: -90,75,3)", 2},
    {"size", KEY_SIZE, "WxH", 0,
     "Size of the picture in pixels (default: 960x540), or of the window (default: 1280x800)", 2},
    {"samples", KEY_SAMPLES, "N", 0, "Draw N x N frames within each pixel of a written picture (default: 3)", 2},
    {0, 0, 0, 0, "Light:", 3},
    {"light", KEY_LIGHT, "THETA,PHI[,...]", 0,
     "A light: degrees from up and around it, and its irradiance over pi (default: 45,-110,1). Up to four; the first "
     "is "
     "the key light. none: no light but the environment",
     3},
    {"shadows", KEY_SHADOWS, "on|off", OPTION_ARG_OPTIONAL, "Shadows of the key light", 3},
    {"environment", KEY_ENVIRONMENT, "MAP.hdr|MAP.exr", 0,
     "Light from a map of the sphere, twice as wide as high; without --light it is the only light. off: none", 3},
    {"environment-turn", KEY_ENVIRONMENT_TURN, "DEG", 0, "Turn the map about the vertical", 3},
    {"environment-strength", KEY_ENVIRONMENT_STRENGTH, "X", 0, "Multiply its radiance (default: 1)", 3},
    {"environment-reference", KEY_ENVIRONMENT_REFERENCE, "on|off", OPTION_ARG_OPTIONAL,
     "Sum every light of the map: slow", 3},
    {"exposure", KEY_EXPOSURE, "X", 0, "Brightness; 1 shows reflectance", 3},
    {"tone", KEY_TONE, "clip|soft", 0, "Cut radiance off at 1 (default), or bend it to 1 from 1/2 on", 3},
    {0, 0, 0, 0, "Evaluation:", 4},
    {"level", KEY_LEVEL, "auto|nearest|none|N", 0,
     "Mip level: between the two that fit the pixel's footprint, the nearer of them, the finest, or this one", 4},
    {"filter", KEY_FILTER, "auto|exact|stochastic", 0,
     "Interpolate every neighbour in every frame, or one drawn at random: noisy at once, the same in the mean", 4},
    {"lobes-on", KEY_LOBES, "N[,N...]|none", 0, "Only these lobes of the material, counted from 1", 4},
    {"tables", KEY_TABLES, "both|view|light|none", 0, "Only these tables of the material", 4},
    {"table-bits", KEY_TABLE_BITS, "N", 0, "Tables as if coded with N bits, 1 to 8", 4},
    {"noise", KEY_NOISE, "SEED|off", 0,
     "Irregularities of the weave, as its file gives them, from this number on (default: off)", 4},
    {"show", KEY_SHOW, "level|extrapolation|none", 0,
     "The mip level in false colour; a tint where view or light lies beyond what was measured", 4},
    {"no-labels", KEY_NO_LABELS, 0, 0, "Leave out the names of the modes and the scale of a difference", 4},
    {0},
};

static void keep_option(scene_options *o, int key, char *argument, struct argp_state *state)
{
    if (o->option_count == SCENE_MAX_OPTIONS)
        argp_error(state, "more than %d options", SCENE_MAX_OPTIONS);
    o->option[o->option_count].key = key;
    o->option[o->option_count++].argument = argument;
}

static void fail(struct argp_state *state, weft_code code, const weft_error *error)
{
    argp_failure(state, (int)code, 0, "%s", error->message);
}

/* Files that the command line names again need not be where the picture says. */
static void forget_files(scene_options *o)
{
    weft_settings *s = &o->settings;
    for (int i = 0; i < o->option_count; i++) {
        int key = o->option[i].key;
        char **name = key == ARGP_KEY_ARG      ? &s->material
                      : key == KEY_RAW         ? &s->dataset
                      : key == KEY_WEAVE       ? &s->weave
                      : key == KEY_MESH        ? &s->mesh
                      : key == KEY_ENVIRONMENT ? &s->environment
                                               : NULL;
        if (name) {
            free(*name);
            *name = NULL;
        }
    }
}

static void start(scene_options *o, struct argp_state *state)
{
    weft_error error = {0};
    for (int i = 0; i < o->option_count; i++)
        if (o->option[i].key == KEY_SETTINGS)
            o->source = o->option[i].argument;
    weft_code code =
        o->source ? weft_settings_read(o->source, &o->settings, &error) : weft_settings_init(&o->settings, &error);
    if (code == WEFT_OK && o->source) {
        forget_files(o);
        code = weft_settings_check_files(&o->settings, o->source, &error);
    }
    if (code != WEFT_OK)
        fail(state, code, &error);
}

static void check_files(const scene_options *o, struct argp_state *state)
{
    const weft_settings *s = &o->settings;
    if (!s->material && !s->dataset && !s->weave)
        argp_error(state, "needs a material, a dataset with --raw, or a weave with --weave");
    const char *const named[WEFT_MODE_COUNT] = {s->dataset, s->material, s->weave};
    static const char *const wanted[WEFT_MODE_COUNT] = {"--raw NAME.btf.h5", "NAME.weft", "--weave CLOTH.wv"};
    for (int i = 0; o->has_modes && i < s->scene.pane_count; i++) {
        weft_mode mode = s->scene.pane[i];
        if (!named[mode])
            argp_error(state, "--mode %s needs %s", weft_mode_name(mode), wanted[mode]);
    }
    if (s->scene.light_count == 0 && !s->scene.environment)
        argp_error(state, "--light none needs --environment");
    if (s->scene.environment && !s->environment)
        argp_error(state, "--environment-... needs --environment MAP.hdr");
}

static void finish(scene_options *o, struct argp_state *state)
{
    start(o, state);
    for (int i = 0; i < o->option_count; i++)
        scene_apply(o, o->option[i].key, o->option[i].argument, state);
    check_files(o, state);
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    scene_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->common;
        return 0;
    case ARGP_KEY_ARG:
        for (int i = 0; i < o->option_count; i++)
            if (o->option[i].key == ARGP_KEY_ARG)
                argp_error(state, "one material at a time: '%s' is one too many", argument);
        keep_option(o, key, argument, state);
        return 0;
    case ARGP_KEY_END:
        finish(o, state);
        return 0;
    default:
        if (key < KEY_SETTINGS || key > KEY_NO_LABELS)
            return ARGP_ERR_UNKNOWN;
        keep_option(o, key, argument, state);
        return 0;
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

const struct argp scene_argp = {option_table, parse_option, NULL, NULL, children, NULL, NULL};

void scene_options_free(scene_options *options)
{
    weft_settings_free(&options->settings);
}
