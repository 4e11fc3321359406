#include "cli/scene_options.h"
#include "cli/arguments.h"

#include "btf/dataset_fingerprint.h"
#include "capture/virtual_cloth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum {
    KEY_RAW = 0x3000,
    KEY_WEAVE,
    KEY_TILES,
    KEY_MODE,
    KEY_MESH,
    KEY_LIGHT,
    KEY_CAMERA,
    KEY_REPEAT,
    KEY_LEVEL,
    KEY_EXPOSURE,
    KEY_SIZE,
    KEY_NO_LABELS
};

enum { LARGEST_PICTURE = 16384 };

static const struct argp_option option_table[] = {
    {"raw", KEY_RAW, "NAME.btf.h5", 0, "Show this dataset in mode raw", 1},
    {"weave", KEY_WEAVE, "CLOTH.wv", 0, "Show this weave in mode analytic", 1},
    {"tiles", KEY_TILES, "X,Y", 0, "Tiles of the weave across the material (default: as the virtual rig lays it)", 1},
    {"mode", KEY_MODE, "MODE", 0, "raw, compressed, analytic, or split: all that are given, side by side", 1},
    {"mesh", KEY_MESH, "MESH", 0, "drape (default), sphere, plane, or an OBJ file with texture coordinates", 2},
    {"repeat", KEY_REPEAT, "N", 0, "Materials across one unit of the mesh (default: 8; 1 for the plane)", 2},
    {"light", KEY_LIGHT, "THETA,PHI", 0, "Direction to the light, degrees from up and around it (default: 45,-110)", 2},
    {"camera", KEY_CAMERA, "AZIMUTH,ELEVATION,DISTANCE", 0,
     "Place of the camera in degrees and radii of the mesh (default: -70,28,3.6; plane: -90,75,3)", 2},
    {"level", KEY_LEVEL, "auto|none|N", 0, "Mip level: by the pixel's footprint, finest, or this one", 2},
    {"exposure", KEY_EXPOSURE, "X", 0, "Brightness; 1 shows reflectance", 2},
    {"size", KEY_SIZE, "WxH", 0, "Size of the picture in pixels (default: 960x540)", 2},
    {"no-labels", KEY_NO_LABELS, 0, 0, "Leave the names of the modes out", 2},
    {0},
};

void scene_options_init(scene_options *options)
{
    options->scene = weft_scene_default();
    options->mesh = "drape";
    options->width = 960;
    options->height = 540;
}

/* ---- Parsing ---- */

static void parse_level(weft_scene *scene, const char *text, struct argp_state *state)
{
    if (strcmp(text, "auto") == 0) {
        scene->level_choice = WEFT_LEVEL_TRILINEAR;
    } else if (strcmp(text, "none") == 0) {
        scene->level_choice = WEFT_LEVEL_NONE;
    } else {
        scene->level_choice = WEFT_LEVEL_FIXED;
        scene->level = parse_number("level", text, 0, WEFT_MATERIAL_MAX_LEVELS, state);
    }
}

static void parse_camera(weft_orbit *orbit, const char *text, struct argp_state *state)
{
    double number[3];
    parse_numbers("camera", text, 3, number, state);
    if (fabs(number[1]) > 90 || !(number[2] > 1))
        argp_error(state, "--camera needs an elevation of at most 90 degrees and a distance over 1, not '%s'", text);
    *orbit = (weft_orbit){
        .azimuth_rad = weft_rad_of_deg(number[0]), .elevation_rad = weft_rad_of_deg(number[1]), .distance = number[2]};
}

static void parse_light(weft_angles *light, const char *text, struct argp_state *state)
{
    double number[2];
    parse_numbers("light", text, 2, number, state);
    *light = (weft_angles){weft_rad_of_deg(number[0]), weft_rad_of_deg(number[1])};
}

static void check_mode(const char *text, struct argp_state *state)
{
    bool known = strcmp(text, "split") == 0;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++)
        known |= strcmp(text, weft_mode_name((weft_mode)mode)) == 0;
    if (!known)
        argp_error(state, "--mode is raw, compressed, analytic or split, not '%s'", text);
}

static void check_files(const scene_options *o, struct argp_state *state)
{
    if (!o->material && !o->dataset && !o->weave)
        argp_error(state, "needs a material, a dataset with --raw, or a weave with --weave");
    const char *const named[WEFT_MODE_COUNT] = {o->dataset, o->material, o->weave};
    static const char *const wanted[WEFT_MODE_COUNT] = {"--raw NAME.btf.h5", "NAME.weft", "--weave CLOTH.wv"};
    for (int mode = 0; o->mode && mode < WEFT_MODE_COUNT; mode++) {
        if (strcmp(o->mode, weft_mode_name((weft_mode)mode)) == 0 && !named[mode])
            argp_error(state, "--mode %s needs %s", o->mode, wanted[mode]);
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    scene_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        scene_options_init(o);
        state->child_inputs[0] = &o->common;
        return 0;
    case KEY_RAW:
        o->dataset = argument;
        return 0;
    case KEY_WEAVE:
        o->weave = argument;
        return 0;
    case KEY_TILES:
        parse_numbers("tiles", argument, 2, o->tiles, state);
        if (!(o->tiles[0] > 0) || !(o->tiles[1] > 0))
            argp_error(state, "--tiles needs two positive numbers, not '%s'", argument);
        return 0;
    case KEY_MODE:
        check_mode(argument, state);
        o->mode = argument;
        return 0;
    case KEY_MESH:
        o->mesh = argument;
        return 0;
    case KEY_REPEAT:
        o->repeat = parse_number("repeat", argument, 1e-3, 1e6, state);
        return 0;
    case KEY_LIGHT:
        parse_light(&o->scene.light[0].direction, argument, state);
        return 0;
    case KEY_CAMERA:
        parse_camera(&o->scene.orbit, argument, state);
        o->has_camera = true;
        return 0;
    case KEY_LEVEL:
        parse_level(&o->scene, argument, state);
        return 0;
    case KEY_EXPOSURE:
        o->scene.exposure = parse_number("exposure", argument, 1e-9, 1e9, state);
        return 0;
    case KEY_SIZE:
        parse_size("size", argument, LARGEST_PICTURE, &o->width, &o->height, state);
        return 0;
    case KEY_NO_LABELS:
        o->scene.labels = false;
        return 0;
    case ARGP_KEY_ARG:
        if (o->material)
            argp_error(state, "one material at a time: '%s' is one too many", argument);
        o->material = argument;
        return 0;
    case ARGP_KEY_END:
        check_files(o, state);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{&common_argp, 0, "Common options:", 9}, {0}};

const struct argp scene_argp = {option_table, parse_option, NULL, NULL, children, NULL, NULL};

/* ---- Loading ---- */

static bool is_plane(const scene_options *o)
{
    return strcmp(o->mesh, "plane") == 0;
}

static weft_code load_mesh(scene_options *o, weft_player *player, weft_error *error)
{
    weft_mesh mesh = {0};
    weft_code code = weft_mesh_open(o->mesh, &mesh, error);
    if (code == WEFT_OK)
        code = weft_player_set_mesh(player, &mesh, error);
    weft_mesh_free(&mesh);
    if (is_plane(o) && !o->has_camera)
        o->scene.orbit =
            (weft_orbit){.azimuth_rad = weft_rad_of_deg(-90), .elevation_rad = weft_rad_of_deg(75), .distance = 3};
    o->scene.repeat = o->repeat > 0 ? o->repeat : is_plane(o) ? 1 : 8;
    return code;
}

/* *metadata is given to the caller. */
static weft_code load_material(const scene_options *o, weft_player *player, char **metadata, weft_error *error)
{
    weft_material material = {0};
    weft_code code = weft_material_read(o->material, &material, error);
    if (code == WEFT_OK)
        code = weft_player_set_material(player, &material, error);
    *metadata = material.metadata;
    material.metadata = NULL;
    weft_material_free(&material);
    return code;
}

static weft_code warn_of_another_origin(const scene_options *o, weft_dataset *dataset, const char *metadata,
                                        weft_error *error)
{
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_dataset_fingerprint_compare(dataset, metadata, warning, error));
    if (warning[0])
        command_say(&o->common, "warning: %s", warning);
    return WEFT_OK;
}

/* `metadata` of the material beside it, or NULL. */
static weft_code load_dataset(const scene_options *o, weft_player *player, const char *metadata, weft_error *error)
{
    weft_dataset *dataset = NULL;
    int skipped_levels = 0;
    weft_progress progress = command_progress(&o->common);
    weft_code code = weft_dataset_open(o->dataset, &dataset, error);
    if (code == WEFT_OK && metadata)
        code = warn_of_another_origin(o, dataset, metadata, error);
    if (code == WEFT_OK)
        code = weft_player_set_dataset(player, dataset, &progress, &skipped_levels, error);
    if (code == WEFT_OK && skipped_levels > 0)
        command_say(&o->common, "'%s' does not fit into graphics memory: its samples are shown at 1/%d of their size",
                    o->dataset, 1 << skipped_levels);
    weft_dataset_close(dataset);
    return code;
}

static weft_code load_weave(const scene_options *o, weft_player *player, weft_error *error)
{
    weft_rig_settings settings = weft_rig_settings_default();
    weft_virtual_cloth cloth = {0};
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_virtual_cloth_read(o->weave, &settings, 0, &cloth, warning, error));
    if (warning[0])
        command_say(&o->common, "%s", warning);
    double tiles_u = o->tiles[0] > 0 ? o->tiles[0] : cloth.tiles_x;
    double tiles_v = o->tiles[1] > 0 ? o->tiles[1] : cloth.tiles_y;
    weft_code code = weft_player_set_weave(player, &cloth.weave, tiles_u, tiles_v, error);
    weft_virtual_cloth_free(&cloth);
    return code;
}

/* One pane for the mode that was asked for, else for the compressed material or what else there is. */
static void choose_panes(scene_options *o, const weft_player *player)
{
    static const weft_mode preference[WEFT_MODE_COUNT] = {WEFT_MODE_COMPRESSED, WEFT_MODE_RAW, WEFT_MODE_ANALYTIC};
    weft_scene *scene = &o->scene;
    scene->pane_count = 0;
    bool split = o->mode && strcmp(o->mode, "split") == 0;
    for (int mode = 0; mode < WEFT_MODE_COUNT; mode++) {
        bool asked = split || (o->mode && strcmp(o->mode, weft_mode_name((weft_mode)mode)) == 0);
        if (asked && weft_player_has(player, (weft_mode)mode))
            scene->pane[scene->pane_count++] = (weft_mode)mode;
    }
    for (int i = 0; i < WEFT_MODE_COUNT && scene->pane_count == 0; i++) {
        if (weft_player_has(player, preference[i]))
            scene->pane[scene->pane_count++] = preference[i];
    }
}

weft_code scene_load(scene_options *o, weft_player *player, weft_error *error)
{
    char *metadata = NULL;
    WEFT_TRY(load_mesh(o, player, error));
    weft_code code = o->material ? load_material(o, player, &metadata, error) : WEFT_OK;
    if (code == WEFT_OK && o->dataset)
        code = load_dataset(o, player, metadata, error);
    free(metadata);
    WEFT_TRY(code);
    if (o->weave)
        WEFT_TRY(load_weave(o, player, error));
    choose_panes(o, player);
    return WEFT_OK;
}

/* ---- Pictures ---- */

weft_code scene_write_image(const char *path, const weft_scene *scene, weft_image *image, weft_error *error)
{
    const char *extension = strrchr(path, '.');
    bool linear = extension && (strcasecmp(extension, ".exr") == 0 || strncasecmp(extension, ".tif", 4) == 0);
    if (!linear)
        weft_scene_show(scene, image);
    return weft_image_write(path, image, "Weft: directional light, radiance = BRDF x pi x cosine x exposure", error);
}
