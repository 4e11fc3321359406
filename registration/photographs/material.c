#include "registration/photographs/steps.h"

#include "base/text/json_text.h"
#include "btf/dataset/dataset.h"
#include "registration/lamp/read.h"
#include "registration/resample/resample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct work {
    const char *folder;
    const weft_photographs_settings *settings;
    const weft_progress *progress;
    weft_photograph_set *set;
    weft_dataset_writer *writer;
    float *inverse_vignetting;
    int *photograph; /* [used_count] index of every image of the dataset */
} work;

static weft_code index_images(work *w, int *count, weft_error *error)
{
    w->photograph = malloc((size_t)w->set->count * sizeof *w->photograph);
    if (!w->photograph)
        return weft_fail_memory(error, "images", (size_t)w->set->count * sizeof *w->photograph);
    *count = 0;
    for (int i = 0; i < w->set->count; i++) {
        if (weft_photographs_used(&w->set->photograph[i]))
            w->photograph[(*count)++] = i;
    }
    return WEFT_OK;
}

static weft_code describe(const work *w, int count, weft_dataset_layout *layout, weft_error *error)
{
    *layout = (weft_dataset_layout){.width = w->settings->width,
                                    .height = w->settings->height,
                                    .image_count = count,
                                    .view_count = count,
                                    .values = WEFT_REFLECTANCE_COSINE,
                                    .distance = WEFT_NEAR,
                                    .texel_pitch_mm = w->settings->target.opening_mm / w->settings->width};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    layout->view_count = 0;
    for (int image = 0; image < count; image++) {
        const weft_photographs_photograph *p = &w->set->photograph[w->photograph[image]];
        weft_vec3 eye = weft_pose_camera_position(&p->pose);
        int view = 0;
        while (view < layout->view_count && weft_length(weft_subtract(layout->view[view], eye)) > 0)
            view++;
        if (view == layout->view_count)
            layout->view[layout->view_count++] = eye;
        layout->view_of_image[image] = view;
        layout->light[image] = p->lamp.position_mm;
    }
    return WEFT_OK;
}

static weft_code invert_vignetting(work *w, weft_error *error)
{
    const weft_camera *camera = &w->set->lens.camera;
    size_t pixels = (size_t)camera->width * (size_t)camera->height;
    w->inverse_vignetting = malloc(pixels * sizeof *w->inverse_vignetting);
    if (!w->inverse_vignetting)
        return weft_fail_memory(error, "the vignetting", pixels * sizeof *w->inverse_vignetting);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < camera->height; y++) {
        for (int x = 0; x < camera->width; x++)
            w->inverse_vignetting[(long)y * camera->width + x] =
                (float)(1 / weft_camera_vignetting(camera, (weft_pixel){x, y}));
    }
    return WEFT_OK;
}

/* Divides weighted sums of light by what a perfect white diffuser would show at each texel, and turns the colours of
 * the camera into linear sRGB where they are known, else those that the file says; sets the mask where the quotient is
 * beyond half floats. */
static void normalise(const weft_photographs_settings *settings, const weft_flash *flash,
                      const weft_photographs_photograph *p, const float *texel, weft_half *half, uint8_t *mask)
{
    const weft_lamp_place *lamp = &p->lamp;
    const weft_colour *colour = settings->colour ? settings->colour : &p->file_colour;
    weft_vec3 l = lamp->position_mm;
    double beam_middle = weft_flash_log_beam(flash, &p->pose, 0, 0);
    for (int y = 0; y < settings->height; y++) {
        for (int x = 0; x < settings->width; x++) {
            long at = (long)y * settings->width + x;
            double side = settings->target.opening_mm, at_x = ((x + 0.5) / settings->width - 0.5) * side;
            double at_y = (0.5 - (y + 0.5) / settings->height) * side, dx = l.x - at_x, dy = l.y - at_y;
            double nearness = weft_dot(l, l) / (dx * dx + dy * dy + l.z * l.z) * WEFT_PHOTOGRAPHS_FULL_SCALE;
            nearness *= exp(weft_flash_log_beam(flash, &p->pose, at_x, at_y) - beam_middle);
            float rgb[3];
            for (int c = 0; c < 3; c++)
                rgb[c] = (float)((double)texel[3 * at + c] / (lamp->level[c] * nearness));
            weft_colour_apply(colour, rgb, 1);
            for (int c = 0; c < 3; c++) {
                half[3 * at + c] = weft_half_of_float(rgb[c]);
                if (!isfinite(weft_float_of_half(half[3 * at + c])))
                    mask[at] |= WEFT_MASK_MISSING;
            }
        }
    }
}

/* The texels of a photograph, [height][width]. */
typedef struct texels {
    size_t count;
    float *light;     /* [3] */
    weft_half *value; /* [3] */
    uint8_t *mask;
} texels;

static void texels_free(texels *t)
{
    free(t->light);
    free(t->value);
    free(t->mask);
}

static weft_code texels_allocate(const weft_photographs_settings *settings, const char *name, texels *t,
                                 weft_error *error)
{
    size_t count = (size_t)settings->width * (size_t)settings->height;
    *t = (texels){count, malloc(count * 3 * sizeof *t->light), malloc(count * 3 * sizeof *t->value), calloc(count, 1)};
    if (t->light && t->value && t->mask)
        return WEFT_OK;
    texels_free(t);
    return weft_fail_memory(error, name, count * 19);
}

static weft_code resample(const work *w, weft_photographs_photograph *p, const weft_light_values *values, texels *t,
                          weft_error *error)
{
    weft_resampler resampler;
    weft_resampling resampling = {.camera = &w->set->lens.camera,
                                  .inverse_vignetting = w->inverse_vignetting,
                                  .homography = p->homography,
                                  .bend = w->set->lens.bend,
                                  .opening_mm = w->settings->target.opening_mm,
                                  .point_spread_px = 2 * sqrt(fmax(0, p->point_spread.constant)),
                                  .fill = true};
    WEFT_TRY(weft_resampler_create(&resampling, w->settings->width, w->settings->height, &resampler, error));
    weft_resampler_apply(&resampler, values->samples, 0, WEFT_PHOTOGRAPHS_FULL_SCALE, t->light, t->mask);
    weft_resampler_free(&resampler);
    weft_photographs_mask_dark(t->light, values->dark * WEFT_PHOTOGRAPHS_FULL_SCALE, t->count, t->mask, p);
    normalise(w->settings, &w->set->lamps.flash, p, t->light, t->value, t->mask);
    return WEFT_OK;
}

static weft_code read_texels(const work *w, weft_photographs_photograph *p, texels *t, weft_error *error)
{
    weft_light_values values = {0};
    char *path = NULL;
    if (asprintf(&path, "%s/%s", w->folder, p->name) < 0)
        return weft_fail_memory(error, p->name, 0);
    weft_code code = weft_light_values_read(path, p->exif.width, p->exif.height, &w->set->tone,
                                            weft_file_range_of(&p->exif, w->settings->clipped_at), &values, error);
    if (code == WEFT_OK)
        code = resample(w, p, &values, t, error);
    weft_light_values_free(&values);
    free(path);
    return code;
}

/* What photograph number `bright` has clipped is taken from its darker darker ones. */
static weft_code fill_from_darker(const work *w, int bright, texels *t, weft_error *error)
{
    weft_photograph_set *set = w->set;
    texels dark;
    weft_code code = WEFT_OK;
    int darker = weft_photographs_darker_of_pair(set, bright);
    if (darker < 0)
        return WEFT_OK;
    WEFT_TRY(texels_allocate(w->settings, set->photograph[darker].name, &dark, error));
    for (; darker >= 0 && code == WEFT_OK; darker = weft_photographs_darker_of_pair(set, darker)) {
        weft_photographs_photograph as_taken = set->photograph[darker];
        if (!as_taken.is_darker_of_pair)
            continue; /* it has another fault */
        memset(dark.mask, 0, dark.count);
        code = read_texels(w, &as_taken, &dark, error);
        if (code == WEFT_OK)
            set->photograph[bright].clipped_texels -=
                weft_photographs_fill_saturated(dark.value, dark.mask, dark.count, t->value, t->mask);
    }
    texels_free(&dark);
    return code;
}

static weft_code put_image(const work *w, int image, weft_error *error)
{
    int index = w->photograph[image];
    weft_photographs_photograph *p = &w->set->photograph[index];
    texels t;
    WEFT_TRY(texels_allocate(w->settings, p->name, &t, error));
    weft_code code = read_texels(w, p, &t, error);
    if (code == WEFT_OK)
        code = fill_from_darker(w, index, &t, error);
    if (code == WEFT_OK) {
        weft_photographs_mask_hidden(w->settings, p->lamp.position_mm, weft_pose_camera_position(&p->pose), t.mask,
                                     &p->hidden_texels);
        p->contrast = weft_photographs_contrast(t.value, t.mask, t.count);
        code = weft_thumbnail_of_texels(t.value, w->settings->width, w->settings->height, &p->rectified, error);
    }
    if (code == WEFT_OK)
        code = weft_dataset_writer_put_image(w->writer, image, t.value, t.mask, error);
    texels_free(&t);
    return code;
}

static weft_code put_all(work *w, int count, weft_error *error)
{
    weft_code result = WEFT_OK;
    long done = 0;
#pragma omp parallel for schedule(dynamic, 1)
    for (int image = 0; image < count; image++) {
        weft_error own = {0};
        weft_code code = put_image(w, image, &own);
#pragma omp critical(weft_photographs_put)
        {
            weft_progress_report(w->progress, "writing the dataset", ++done, count);
            if (code != WEFT_OK && result == WEFT_OK) {
                result = code;
                *error = own;
            }
        }
    }
    return result;
}

static json_t *pack_photograph(const weft_photographs_photograph *p)
{
    if (!weft_photographs_used(p))
        return json_pack("{so ss}", "file", weft_json_text(p->name, strlen(p->name)), "left_out", p->remark);
    weft_vec3 eye = weft_pose_camera_position(&p->pose), lamp = p->lamp.position_mm;
    return json_pack("{so sf sf sf s[fff] s[fff] sf s[fff] sI sI sI}", "file", weft_json_text(p->name, strlen(p->name)),
                     "corner_rms_px", p->corner_rms_px, "correlation", p->correlation, "standard_error_mm",
                     p->uncertainty_mm, "camera_mm", eye.x, eye.y, eye.z, "lamp_mm", lamp.x, lamp.y, lamp.z,
                     "lamp_uncertainty_deg", p->lamp.uncertainty_deg, "white_level", p->lamp.level[0], p->lamp.level[1],
                     p->lamp.level[2], "clipped_texels", (json_int_t)p->clipped_texels, "dark_texels",
                     (json_int_t)p->dark_texels, "hidden_texels", (json_int_t)p->hidden_texels);
}

/* What told the tone curve, and how well. */
static json_t *pack_knowledge_of_tone(const weft_photograph_set *set)
{
    json_t *pairs = json_array();
    for (int i = 0; i < set->pair_count; i++) {
        const char *bright = set->photograph[set->pair[i].bright].name;
        const char *dark = set->photograph[set->pair[i].dark].name;
        weft_json_append(&pairs,
                         json_pack("[oo]", weft_json_text(bright, strlen(bright)), weft_json_text(dark, strlen(dark))));
    }
    return json_pack("{sb so sf sf}", "found", set->tone_found, "exposure_pairs", pairs, "standard_error_of_a_tenth",
                     set->lamps.dark_error, "relative_standard_error_of_ink", set->lamps.ink_error);
}

static char *provenance(const work *w)
{
    const weft_camera *c = &w->set->lens.camera;
    const weft_lens_errors *e = &w->set->lens.errors;
    json_t *photographs = json_array(), *tone = json_array();
    for (int i = 0; i <= WEFT_TONE_STEPS; i += WEFT_TONE_STEPS / 64)
        weft_json_append(&tone, json_real((double)w->set->tone.linear[i]));
    for (int i = 0; i < w->set->count; i++)
        weft_json_append(&photographs, pack_photograph(&w->set->photograph[i]));
    json_t *root = json_pack("{ss s{si si sf sf sf sf sf sf s[fff] s{sf sf sf}} sf sf so so}", "program",
                             "weft photographs " WEFT_VERSION, "lens", "width", c->width, "height", c->height, "fx",
                             c->fx, "fy", c->fy, "cx", c->cx, "cy", c->cy, "k1", c->k1, "k2", c->k2, "vignetting",
                             c->vignetting[0], c->vignetting[1], c->vignetting[2], "standard_error", "f", e->focal_px,
                             "k1", e->k1, "k2", e->k2, "opening_mm", w->settings->target.opening_mm, "ink_over_paper",
                             w->set->lamps.ink, "tone", tone, "photographs", photographs);
    const weft_bend *bend = &w->set->lens.bend;
    weft_json_put(&root, "bend",
                  json_pack("{s[fff] sf sf}", "per_mm", bend->xx, bend->xy, bend->yy, "size_mm",
                            weft_lens_bow_mm(bend, &w->settings->target), "standard_error_mm_at_100_mm",
                            w->set->lens.bend_error_mm));
    weft_json_put(&root, "tone_curve", pack_knowledge_of_tone(w->set));
    if (w->settings->colour)
        weft_json_put(&root, "colour", weft_colour_pack(w->settings->colour));
    char *text = root ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);
    return text;
}

static weft_code write(work *w, const char *output, int count, weft_dataset_layout *layout, weft_error *error)
{
    WEFT_TRY(describe(w, count, layout, error));
    WEFT_TRY(invert_vignetting(w, error));
    WEFT_TRY(weft_dataset_writer_create(output, layout, &w->writer, error));
    WEFT_TRY(put_all(w, count, error));
    WEFT_TRY(weft_photographs_check_still(w->folder, w->settings, w->set, error));
    WEFT_TRY(weft_photographs_put_figures(w->set, w->photograph, count, layout->texel_pitch_mm, w->writer, error));
    char *text = provenance(w);
    if (!text)
        return weft_fail_memory(error, "provenance", 0);
    weft_dataset_writer *writer = w->writer;
    w->writer = NULL;
    weft_code code = weft_dataset_writer_finish(writer, text, error);
    free(text);
    return code;
}

weft_code weft_photographs_write_dataset(const char *folder, const char *output,
                                         const weft_photographs_settings *settings, const weft_progress *progress,
                                         weft_photograph_set *set, weft_error *error)
{
    work w = {.folder = folder, .settings = settings, .progress = progress, .set = set};
    weft_dataset_layout layout = {0};
    int count = 0;
    weft_code code = index_images(&w, &count, error);
    if (code == WEFT_OK)
        code = write(&w, output, count, &layout, error);
    weft_dataset_writer_abandon(w.writer);
    weft_dataset_layout_free(&layout);
    free(w.inverse_vignetting);
    free(w.photograph);
    return code;
}
