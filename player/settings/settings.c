#include "player/settings/settings.h"

#include "base/atomic_file.h"
#include "player/scene/surroundings.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const char description[] = "Weft: radiance = BRDF x pi x cosine x irradiance x exposure";
static const size_t largest_text = (size_t)1 << 20;

weft_code weft_settings_init(weft_settings *settings, weft_error *error)
{
    *settings = (weft_settings){
        .mesh = strdup("drape"),
        .real_size = true,
        .width = 960,
        .height = 540,
        .samples = 3,
        .scene = weft_scene_default(),
    };
    return settings->mesh ? WEFT_OK : weft_fail_memory(error, "settings", 0);
}

void weft_settings_free(weft_settings *settings)
{
    free(settings->material);
    free(settings->dataset);
    free(settings->weave);
    free(settings->environment);
    free(settings->mesh);
    *settings = (weft_settings){0};
}

static bool has_extension(const char *path, const char *extension)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot, extension) == 0;
}

weft_code weft_settings_read(const char *path, weft_settings *settings, weft_error *error)
{
    char *text = NULL;
    size_t size = 0;
    *settings = (weft_settings){0};
    if (has_extension(path, ".json")) {
        WEFT_TRY(weft_read_file(path, largest_text, &text, &size, error));
    } else {
        WEFT_TRY(weft_image_read_settings(path, &text, error));
        if (!text)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' carries no settings of Weft", path);
        size = strlen(text);
    }
    weft_code code = weft_settings_parse(text, size, path, settings, error);
    free(text);
    return code;
}

weft_code weft_settings_check_files(const weft_settings *s, const char *source, weft_error *error)
{
    static const char *const kind[] = {"material", "dataset", "weave", "environment", "mesh"};
    const char *const file[] = {s->material, s->dataset, s->weave,
                                s->environment && !weft_surroundings_are(s->environment) ? s->environment : NULL,
                                s->mesh && !weft_mesh_is_built_in(s->mesh) ? s->mesh : NULL};
    for (size_t i = 0; i < sizeof file / sizeof file[0]; i++)
        if (file[i] && access(file[i], F_OK) != 0)
            return weft_fail(error, WEFT_BAD_INPUT, "'%s' shows the %s '%s', which is not there", source, kind[i],
                             file[i]);
    return WEFT_OK;
}

double weft_settings_repeat(const weft_settings *settings, const weft_mesh *mesh, double material_width_mm,
                            double plane_mm)
{
    if (!settings->real_size || !(mesh->size > 0 && mesh->coordinate_length > 0 && material_width_mm > 0))
        return settings->scene.repeat;
    bool is_plane = strcmp(settings->mesh, "plane") == 0;
    double unit_mm = settings->mesh_unit_mm;
    double size_mm = settings->mesh_size_mm > 0              ? settings->mesh_size_mm
                     : is_plane                              ? plane_mm
                     : unit_mm > 0                           ? unit_mm * mesh->size
                     : strcmp(settings->mesh, "sphere") == 0 ? WEFT_SETTINGS_SPHERE_MM
                                                             : WEFT_SETTINGS_MESH_MM;
    return mesh->coordinate_length * size_mm / (mesh->size * material_width_mm);
}

/* ---- Pictures ---- */

bool weft_settings_is_picture(const char *path)
{
    return has_extension(path, ".png") || weft_settings_is_linear(path);
}

bool weft_settings_is_linear(const char *path)
{
    return has_extension(path, ".exr") || has_extension(path, ".tif") || has_extension(path, ".tiff");
}

static weft_code draw(const char *path, weft_player *player, const weft_settings *settings, const char *text,
                      const weft_progress *progress, weft_error *error)
{
    weft_image image = {0};
    weft_scene scene = settings->scene;
    bool is_linear = weft_settings_is_linear(path);
    /* Linear differences are numbers, and the scale would cover some. */
    scene.labels &= !(is_linear && scene.layout == WEFT_LAYOUT_DIFFERENCE);
    WEFT_TRY(weft_player_picture(player, &scene, settings->width, settings->height, settings->samples, progress, &image,
                                 error));
    if (!is_linear)
        weft_scene_show(&settings->scene, &image);
    weft_code code = weft_image_write_settings(path, &image, description, text, error);
    weft_image_free(&image);
    return code;
}

weft_code weft_settings_draw(const char *path, weft_player *player, const weft_settings *settings,
                             const weft_progress *progress, weft_error *error)
{
    char *text = NULL;
    weft_settings written = {0};
    WEFT_TRY(weft_settings_format(settings, path, &text, error));
    weft_code code = weft_settings_parse(text, strlen(text), path, &written, error);
    if (code == WEFT_OK)
        code = draw(path, player, &written, text, progress, error);
    weft_settings_free(&written);
    free(text);
    return code;
}
