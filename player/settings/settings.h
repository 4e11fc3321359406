/* All that makes a picture: the scene, the files in it and the size. Written into every picture that Weft draws, so
 * that it can be drawn again (docs/reference/scene.md). */
#ifndef WEFT_PLAYER_SETTINGS_SETTINGS_H
#define WEFT_PLAYER_SETTINGS_SETTINGS_H

#include "btf/dataset/measured.h"
#include "player/draw/player.h"
#include "player/raw/format.h"
#include "player/scene/scene.h"
#include "player/settings/schema.h"

/* Every name of a file is owned; NULL: none. */
typedef struct weft_settings {
    char *material, *dataset, *weave, *environment; /* files */
    char *mesh;                                     /* "drape", "sphere", "plane" or a file */
    weft_raw_format raw_format;                     /* how samples of the dataset are kept */
    double mesh_size_mm; /* length of the mesh's `size`; 0: that of its kind below, or as mesh_unit_mm says */
    double mesh_unit_mm; /* length of a file's unit; 0: not known */
    bool real_size;      /* the scene's `repeat` follows from the sizes of cloth and mesh */
    double tiles[2];     /* of the weave across the material; 0: as the virtual rig lays it out */
    int width, height;
    int samples; /* samples x samples frames for a picture */
    weft_scene scene;
    /* What the text does not have: how the settings came about */
    const char *source;  /* the picture or text that they began from, or NULL */
    uint64_t given;      /* the options that were given, a bit for each setting of the schema */
    bool split;          /* the modes were asked for as "split" */
    bool has_lights;     /* lights were asked for, or their absence */
    bool is_of_one_view; /* what is shown first was photographed from one direction alone; the first look tells */
    /* What the files that are shown were measured from, where they say it; the loader fills it in */
    bool knows_measured[WEFT_MODE_COUNT];
    weft_measured measured[WEFT_MODE_COUNT];
} weft_settings;

enum {
    WEFT_SETTINGS_MAX_SIDE = 16384,
    WEFT_SETTINGS_MAX_SAMPLES = 64,
    WEFT_SETTINGS_MESH_MM = 300,
    WEFT_SETTINGS_SPHERE_MM = 60,
    WEFT_SETTINGS_SWATCH_MM = 20
};

/* The default scene on the drape, 960 x 540, no models. The caller frees with weft_settings_free.
 * Errors: WEFT_SYSTEM. */
weft_code weft_settings_init(weft_settings *settings, weft_error *error);
void weft_settings_free(weft_settings *settings);

/* An option as it was given. */
typedef struct weft_given_option {
    const weft_setting *setting;
    const char *text; /* must live on; NULL: none */
} weft_given_option;

/* The settings that options come to. --settings comes before all others, wherever it stands; the others follow in their
 * order. Every file that they name is there. The caller frees with weft_settings_free, also on failure. Errors:
 * WEFT_BAD_USAGE for an option that cannot be understood and for options that lack another; those of weft_settings_read
 * and weft_settings_check_files. */
weft_code weft_settings_of_options(const weft_given_option *option, int count, weft_settings *settings,
                                   weft_error *error);

/* Whether an option of this name was given. Pure. */
bool weft_settings_has(const weft_settings *settings, const char *name);

/* Lights the scene by a built-in environment, with its shadows on a ground and highlights that keep their shape, where
 * no option says otherwise. */
void weft_settings_light(weft_settings *settings, const char *surroundings);

/* As JSON. Names of files are those seen from the folder of `beside`, so that a folder can be moved with all that is in
 * it. The caller frees *text. Errors: WEFT_BAD_USAGE for numbers that are not finite; WEFT_BAD_INPUT where the folder
 * of a file does not exist; WEFT_SYSTEM. */
weft_code weft_settings_format(const weft_settings *settings, const char *beside, char **text, weft_error *error);

/* Reads what weft_settings_format writes; what is left out keeps its default, and angles lie within an ulp of those
 * that were written. `source` names the text in messages, and files are looked for from its folder. The caller frees
 * with weft_settings_free. Errors: WEFT_BAD_INPUT for text that is no such JSON, naming the key; WEFT_SYSTEM. */
weft_code weft_settings_parse(const char *text, size_t size, const char *source, weft_settings *settings,
                              weft_error *error);

/* Reads the settings of a picture, or of a file whose name ends in .json. The caller frees with weft_settings_free.
 * Errors: those of weft_settings_parse; WEFT_BAD_INPUT for a picture that carries none or cannot be read. */
weft_code weft_settings_read(const char *path, weft_settings *settings, weft_error *error);

/* Every file of the settings that `source` gave is there. Errors: WEFT_BAD_INPUT naming `source` and the file. */
weft_code weft_settings_check_files(const weft_settings *settings, const char *source, weft_error *error);

/* Materials for one unit of the texture coordinates of `mesh`: with real_size so many that a material is
 * material_width_mm wide on it, else what the scene says. plane_mm is the side of the plane where the settings give
 * none. Pure. */
double weft_settings_repeat(const weft_settings *settings, const weft_mesh *mesh, double material_width_mm,
                            double plane_mm);

/* Gives a plane the sides of a material, `proportion` times as high as wide, where it is the mesh of the settings and
 * shows the material once: at its real size, and no other size is given. Other meshes stay. */
void weft_settings_lay_plane(const weft_settings *settings, double proportion, weft_mesh *mesh);

/* Whether a picture can be written under this name: .png, .exr, .tif. Pure. */
bool weft_settings_is_picture(const char *path);

/* Whether a picture of this name holds linear values, which no tone bends. Pure. */
bool weft_settings_is_linear(const char *path);

/* Draws the picture and writes it with its settings: .png as the screen shows it, .exr linear (.tif too, but without
 * settings) and without the scale of a difference. It is drawn from what the written text says, so that the text gives
 * the same picture bit for bit. What `player` shows must be what the settings name. Atomic. Errors: those of
 * weft_settings_format, weft_player_picture and weft_image_write. */
weft_code weft_settings_draw(const char *path, weft_player *player, const weft_settings *settings,
                             const weft_progress *progress, weft_error *error);

#endif
