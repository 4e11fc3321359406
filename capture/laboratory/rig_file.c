#include "capture/laboratory/rig_file.h"

#include "base/text/text_file.h"

#include <confuse.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- What libconfuse has to say ---- */

/* It calls back without a context. */
typedef struct reading {
    const char *path;
    bool failed; /* the first message is the cause */
    weft_error *error;
} reading;

static reading current;

static void report(cfg_t *cfg, const char *format, va_list arguments)
{
    char text[WEFT_MESSAGE_SIZE / 2];
    if (current.failed)
        return;
    current.failed = true;
    vsnprintf(text, sizeof text, format, arguments);
    weft_error_set(current.error, WEFT_BAD_INPUT, "%s:%d: %s", current.path, cfg ? cfg->line : 0, text);
}

/* ---- Values ---- */

static const char *section_of(const cfg_t *cfg)
{
    return strcmp(cfg->name, "root") == 0 ? "" : cfg->name;
}

static int check_number(cfg_t *cfg, const weft_rig_key *key, double value)
{
    bool whole = key->kind != WEFT_KEY_NUMBER;
    if (value >= key->low && value <= key->high && (!whole || value == floor(value)))
        return 0;
    cfg_error(cfg, "'%s' must be a %snumber from %g to %g", key->name, whole ? "whole " : "", key->low, key->high);
    return -1;
}

static int check_text(cfg_t *cfg, const weft_rig_key *key, const char *value)
{
    if (strlen(value) < WEFT_RIG_TEXT_SIZE && (*value || !key->required))
        return 0;
    cfg_error(cfg, "'%s' must have 1 to %d characters", key->name, WEFT_RIG_TEXT_SIZE - 1);
    return -1;
}

static int index_of_word(const weft_rig_key *key, const char *word)
{
    for (int i = 0; key->words[i]; i++) {
        if (strcmp(key->words[i], word) == 0)
            return i;
    }
    return -1;
}

static int check_word(cfg_t *cfg, const weft_rig_key *key, const char *value)
{
    char list[WEFT_RIG_TEXT_SIZE] = "";
    if (index_of_word(key, value) >= 0)
        return 0;
    for (int i = 0; key->words[i]; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i ? ", " : "", key->words[i]);
    cfg_error(cfg, "'%s' must be one of: %s", key->name, list);
    return -1;
}

static int check_value(cfg_t *cfg, cfg_opt_t *opt)
{
    const weft_rig_key *key = weft_rig_key_find(section_of(cfg), opt->name);
    if (!key || cfg_opt_size(opt) == 0)
        return 0;
    if (key->kind == WEFT_KEY_TEXT || key->kind == WEFT_KEY_WORD) {
        const char *value = cfg_opt_getnstr(opt, 0);
        return key->kind == WEFT_KEY_TEXT ? check_text(cfg, key, value) : check_word(cfg, key, value);
    }
    return key->kind == WEFT_KEY_FLAG ? 0 : check_number(cfg, key, cfg_opt_getnfloat(opt, 0));
}

/* ---- The schema as libconfuse takes it ---- */

static cfg_opt_t option_of_key(const weft_rig_key *key)
{
    cfg_flag_t flags = key->required ? CFGF_NODEFAULT : CFGF_NONE;
    bool text = key->kind == WEFT_KEY_TEXT || key->kind == WEFT_KEY_WORD;
    const char *usual = key->text ? key->text : "";
    cfg_opt_t string = CFG_STR(key->name, usual, flags), number = CFG_FLOAT(key->name, key->value, flags),
              flag = CFG_BOOL(key->name, cfg_false, flags);
    cfg_opt_t option = text ? string : key->kind == WEFT_KEY_FLAG ? flag : number;
    option.validcb = check_value;
    return option;
}

/* Room for the options of the file: its keys, its sections, the end. */
typedef struct options {
    cfg_opt_t of[WEFT_RIG_SECTION_COUNT][WEFT_RIG_KEYS_MAX + WEFT_RIG_SECTION_COUNT + 1];
} options;

static int check_section(cfg_t *cfg, cfg_opt_t *opt);

static void lay_out(options *o)
{
    const cfg_opt_t end = CFG_END();
    int file_count = weft_rig_schema[0].key_count;
    for (int s = WEFT_RIG_SECTION_COUNT - 1; s >= 0; s--) {
        const weft_rig_section *section = &weft_rig_schema[s];
        for (int k = 0; k < section->key_count; k++)
            o->of[s][k] = option_of_key(&section->key[k]);
        if (s == 0)
            continue;
        o->of[s][section->key_count] = end;
        bool is_axis = strcmp(section->name, "axis") == 0;
        cfg_opt_t option =
            CFG_SEC(section->name, o->of[s], CFGF_MULTI | (is_axis ? CFGF_TITLE | CFGF_NO_TITLE_DUPES : CFGF_NONE));
        option.validcb = check_section;
        o->of[0][file_count + s - 1] = option;
    }
    o->of[0][file_count + WEFT_RIG_SECTION_COUNT - 1] = end;
}

/* ---- Sections ---- */

static int check_complete(cfg_t *section, const weft_rig_section *schema, cfg_t *at)
{
    for (int k = 0; k < schema->key_count; k++) {
        if (schema->key[k].required && cfg_size(section, schema->key[k].name) == 0) {
            cfg_error(at, "%s%s lacks '%s'", *schema->name ? "section " : "the file", schema->name,
                      schema->key[k].name);
            return -1;
        }
    }
    return 0;
}

static const weft_rig_section *schema_of(const char *name)
{
    const weft_rig_section *section = weft_rig_schema;
    while (strcmp(section->name, name) != 0)
        section++;
    return section;
}

/* Called where the section ends. */
static int check_section(cfg_t *cfg, cfg_opt_t *opt)
{
    bool is_axis = strcmp(opt->name, "axis") == 0, is_camera = strcmp(opt->name, "camera") == 0;
    unsigned most = is_axis ? WEFT_AXES_MAX : is_camera ? WEFT_CAMERAS_MAX : 1;
    if (cfg_opt_size(opt) > most) {
        cfg_error(cfg,
                  is_axis     ? "there are more than %u axes"
                  : is_camera ? "there are more than %u cameras"
                              : "a rig has %u section '%s'",
                  most, opt->name);
        return -1;
    }
    cfg_t *section = cfg_opt_getnsec(opt, cfg_opt_size(opt) - 1);
    const char *title = cfg_title(section);
    if (is_axis && (!title || !*title || strlen(title) >= WEFT_AXIS_NAME_SIZE)) {
        cfg_error(cfg, "the name of an axis has 1 to %d characters", WEFT_AXIS_NAME_SIZE - 1);
        return -1;
    }
    if (check_complete(section, schema_of(opt->name), cfg) != 0)
        return -1;
    if (is_axis && cfg_getfloat(section, "low_deg") >= cfg_getfloat(section, "high_deg")) {
        cfg_error(cfg, "axis '%s': 'low_deg' must be below 'high_deg'", title);
        return -1;
    }
    return 0;
}

/* ---- Into the structure ---- */

static void take_key(cfg_t *section, const weft_rig_key *key, void *structure)
{
    void *place = (char *)structure + key->offset;
    if (key->kind == WEFT_KEY_TEXT)
        snprintf(place, WEFT_RIG_TEXT_SIZE, "%s", cfg_getstr(section, key->name));
    else if (key->kind == WEFT_KEY_WORD)
        *(int *)place = index_of_word(key, cfg_getstr(section, key->name));
    else if (key->kind == WEFT_KEY_FLAG)
        *(bool *)place = cfg_getbool(section, key->name);
    else if (key->kind == WEFT_KEY_INT)
        *(int *)place = (int)cfg_getfloat(section, key->name);
    else
        *(double *)place = cfg_getfloat(section, key->name);
}

static void take_section(cfg_t *section, const weft_rig_section *schema, void *structure)
{
    for (int k = 0; k < schema->key_count; k++)
        take_key(section, &schema->key[k], structure);
}

static void take_axes(cfg_t *cfg, weft_axes *axes)
{
    axes->count = (int)cfg_size(cfg, "axis");
    for (int k = 0; k < axes->count; k++) {
        cfg_t *section = cfg_getnsec(cfg, "axis", (unsigned)k);
        take_section(section, schema_of("axis"), &axes->axis[k]);
        snprintf(axes->axis[k].name, sizeof axes->axis[k].name, "%s", cfg_title(section));
    }
}

static void take_cameras(cfg_t *cfg, weft_rig_file *rig)
{
    rig->camera_count = (int)cfg_size(cfg, "camera");
    for (int i = 0; i < rig->camera_count; i++)
        take_section(cfg_getnsec(cfg, "camera", (unsigned)i), schema_of("camera"), &rig->camera[i]);
}

static int take_file(cfg_t *cfg, weft_rig_file *rig)
{
    if (check_complete(cfg, &weft_rig_schema[0], cfg) != 0)
        return -1;
    take_section(cfg, &weft_rig_schema[0], rig);
    take_axes(cfg, &rig->axes);
    for (int s = 2; s < WEFT_RIG_SECTION_COUNT; s++) {
        const weft_rig_section *schema = &weft_rig_schema[s];
        if (cfg_size(cfg, schema->name) == 0) {
            cfg_error(cfg, "there is no section '%s'", schema->name);
            return -1;
        }
        if (strcmp(schema->name, "camera") != 0)
            take_section(cfg_getsec(cfg, schema->name), schema, (char *)rig + schema->offset);
    }
    take_cameras(cfg, rig);
    return 0;
}

/* ---- What goes together ---- */

static void fix_angles(weft_rig_file *rig)
{
    weft_axes *axes = &rig->axes;
    axes->together = !rig->stage.one_by_one;
    axes->lamps = rig->light.lamps[0] != 0;
    axes->fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_THETA] = rig->camera[0].theta_deg;
    axes->fixed_deg[WEFT_BODY_CAMERA][WEFT_TURN_PHI] = rig->camera[0].phi_deg;
    axes->fixed_deg[WEFT_BODY_LIGHT][WEFT_TURN_THETA] = rig->light.theta_deg;
    axes->fixed_deg[WEFT_BODY_LIGHT][WEFT_TURN_PHI] = rig->light.phi_deg;
}

/* ---- Cameras ---- */

static weft_code check_camera(const weft_rig_file *rig, const weft_camera_description *camera, weft_error *error)
{
    bool controller = rig->stage.backend == WEFT_STAGE_USB;
    if (camera->trigger == WEFT_TRIGGER_STAGE && !controller)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: a shutter at the stage's controller needs the stage 'usb'",
                         rig->path);
    if (camera->shortest_exposure_s > camera->longest_exposure_s)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: the longest exposure, %g s, is below the shortest, %g s",
                         rig->path, camera->longest_exposure_s, camera->shortest_exposure_s);
    if (rig->camera_count > 1 && !weft_camera_name_is_sound(camera->name))
        return weft_fail(error, WEFT_BAD_INPUT,
                         "%s: each of several cameras needs a name of 1 to %d letters, digits, '-' and '_', not '%s'",
                         rig->path, WEFT_CAMERA_NAME_SIZE - 1, camera->name);
    return WEFT_OK;
}

/* What two cameras cannot share. */
static weft_code check_camera_pair(const weft_rig_file *rig, const weft_camera_description *a,
                                   const weft_camera_description *b, weft_error *error)
{
    if (strcasecmp(a->name, b->name) == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: two cameras are called '%s'", rig->path, a->name);
    if (a->backend == b->backend && strcmp(a->device, b->device) == 0)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: cameras '%s' and '%s' are the same device '%s'", rig->path,
                         a->name, b->name, a->device);
    if (a->trigger == WEFT_TRIGGER_STAGE && b->trigger == WEFT_TRIGGER_STAGE)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: cameras '%s' and '%s' hang on one shutter contact", rig->path,
                         a->name, b->name);
    return WEFT_OK;
}

static weft_code check_cameras(const weft_rig_file *rig, weft_error *error)
{
    for (int i = 0; i < rig->camera_count; i++) {
        WEFT_TRY(check_camera(rig, &rig->camera[i], error));
        for (int other = 0; other < i; other++)
            WEFT_TRY(check_camera_pair(rig, &rig->camera[other], &rig->camera[i], error));
    }
    return WEFT_OK;
}

static weft_code check_devices(const weft_rig_file *rig, weft_error *error)
{
    bool controller = rig->stage.backend == WEFT_STAGE_USB;
    for (int k = 0; k < rig->axes.count; k++) {
        const weft_axis *axis = &rig->axes.axis[k];
        if (!axis->by_hand && !controller)
            return weft_fail(error, WEFT_BAD_INPUT, "%s: nobody drives axis '%s': by_hand = yes, or the stage 'usb'",
                             rig->path, axis->name);
    }
    if (rig->light.backend == WEFT_LIGHT_STAGE && !controller)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: a light at the stage's controller needs the stage 'usb'",
                         rig->path);
    if (rig->axes.lamps && rig->light.backend == WEFT_LIGHT_NONE)
        return weft_fail(error, WEFT_BAD_INPUT, "%s: lamps that nobody switches: give the light a back end", rig->path);
    return check_cameras(rig, error);
}

/* ---- Reading ---- */

/* A rig with one camera may name them beside its section. */
static weft_code take_poses(weft_rig_file *rig, weft_error *error)
{
    weft_camera_description *camera = &rig->camera[0];
    if (!rig->poses[0])
        return WEFT_OK;
    if (rig->camera_count > 1)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "%s: 'poses' are of one camera, the rig has %d: each names its own in its section", rig->path,
                         rig->camera_count);
    if (camera->poses[0])
        return weft_fail(error, WEFT_BAD_INPUT, "%s: 'poses' are named twice", rig->path);
    snprintf(camera->poses, sizeof camera->poses, "%s", rig->poses);
    return WEFT_OK;
}

static weft_code parse(const char *text, weft_rig_file *rig, weft_error *error)
{
    static options layout;
    lay_out(&layout);
    cfg_t *cfg = cfg_init(layout.of[0], CFGF_NONE);
    if (!cfg)
        return weft_fail_memory(error, "rig file", 0);
    cfg_set_error_function(cfg, report);
    current = (reading){.path = rig->path, .error = error};
    bool sound = cfg_parse_buf(cfg, text) == CFG_SUCCESS && take_file(cfg, rig) == 0;
    cfg_free(cfg);
    if (sound)
        return WEFT_OK;
    return current.failed ? WEFT_BAD_INPUT : weft_fail(error, WEFT_BAD_INPUT, "'%s' is no rig file", rig->path);
}

weft_code weft_rig_file_read(const char *path, weft_rig_file *rig, weft_error *error)
{
    char *text;
    *rig = (weft_rig_file){0};
    if (strlen(path) >= sizeof rig->path)
        return weft_fail(error, WEFT_BAD_INPUT, "the path of the rig file is longer than %zu characters",
                         sizeof rig->path - 1);
    snprintf(rig->path, sizeof rig->path, "%s", path);
    WEFT_TRY(weft_text_file_read(path, &text, error));
    weft_code code = parse(text, rig, error);
    free(text);
    WEFT_TRY(code);
    fix_angles(rig);
    WEFT_TRY(take_poses(rig, error));
    WEFT_TRY(weft_axes_check(&rig->axes, path, error));
    return check_devices(rig, error);
}

weft_code weft_rig_file_beside(const weft_rig_file *rig, const char *name, char *path, size_t size, weft_error *error)
{
    const char *slash = strrchr(rig->path, '/');
    int folder = name[0] == '/' || !slash ? 0 : (int)(slash + 1 - rig->path);
    int length = snprintf(path, size, "%.*s%s", folder, rig->path, name);
    return length < (int)size ? WEFT_OK
                              : weft_fail(error, WEFT_BAD_INPUT, "%s: the path of '%s' is too long", rig->path, name);
}
