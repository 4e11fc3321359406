#include "geometry/acquisition/acquisition.h"

#include "base/text/json_text.h"
#include "btf/dataset/dataset.h"
#include "geometry/acquisition/view_samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LOWEST_COSINE 0.17364817766693034885 /* of 80 degrees */
#define GOLDEN_ANGLE 2.39996322972865332223  /* pi (3 - sqrt(5)) */

enum { MAX_TEXELS_ACROSS = 4096, PROBES = 64 /* across the tile */ };

/* An acquisition under way. */
typedef struct acquisition {
    const weft_stitch *stitch;
    const weft_tile_mesh *mesh;
    const weft_vec3 *direction;
    int direction_count;
    const weft_acquisition_options *options;
    const char *path;
    weft_acquisition_report *report;
    weft_dataset_writer *writer;
    weft_illumination *illumination;
    weft_view_samples samples;
    weft_half *image;      /* [height][width][3] */
    float *opacity;        /* [height][width][direction_count] */
    weft_frame_sum *frame; /* [height][width] each view weighs by what it sees of the texel's cloth */
} acquisition;

weft_vec3 weft_acquisition_direction(int index)
{
    weft_real z = 1 - (1 - (weft_real)LOWEST_COSINE) * (index + (weft_real)0.5) / WEFT_ACQUISITION_DIRECTIONS;
    weft_real radius = sqrt(1 - z * z), phi = index * (weft_real)GOLDEN_ANGLE;
    return weft_vec3_of(radius * cos(phi), radius * sin(phi), z);
}

static weft_code check_request(const acquisition *a, weft_error *error)
{
    const weft_acquisition_options *options = a->options;
    if (options->width < 1 || options->height < 1 || options->width > MAX_TEXELS_ACROSS ||
        options->height > MAX_TEXELS_ACROSS)
        return weft_fail(error, WEFT_BAD_USAGE, "%d x %d texels: 1 to %d can be simulated", options->width,
                         options->height, MAX_TEXELS_ACROSS);
    if (!(options->noise > 0))
        return weft_fail(error, WEFT_BAD_USAGE, "noise of %g: it must be above 0", options->noise);
    double depth_mm = (double)(a->mesh->top - a->mesh->bottom);
    if (!(options->plane_mm <= 0 && options->plane_mm >= -depth_mm))
        return weft_fail(error, WEFT_BAD_USAGE,
                         "texels %g mm above the top of the cloth: it is %.3g mm thick, and they lie in it",
                         options->plane_mm, depth_mm);
    for (int i = 0; i < a->direction_count; i++)
        if (!(a->direction[i].z > 1e-3))
            return weft_fail(error, WEFT_BAD_USAGE, "direction %d is (%.3g, %.3g, %.3g), not above the horizon", i + 1,
                             a->direction[i].x, a->direction[i].y, a->direction[i].z);
    return WEFT_OK;
}

static char *provenance(const acquisition *a)
{
    const weft_acquisition_options *options = a->options;
    json_t *object = json_pack("{s:s, s:s, s:i, s:i, s:f, s:I}", "source", "simulated from a stitch", "stitch",
                               a->stitch->name, "triangles", a->mesh->triangle_count, "bounces", options->bounces,
                               "noise", a->report->noise, "seed", (json_int_t)options->seed);
    if (options->plane_mm < 0)
        weft_json_put(&object, "plane_below_top_mm", json_real(-options->plane_mm));
    char *text = object ? json_dumps(object, JSON_INDENT(2)) : NULL;
    json_decref(object);
    return text;
}

static weft_code fill_layout(const acquisition *a, weft_dataset_layout *layout, weft_error *error)
{
    int n = a->direction_count;
    weft_real across = a->stitch->width / a->options->width, up = a->stitch->height / a->options->height;
    *layout = (weft_dataset_layout){.width = a->options->width,
                                    .height = a->options->height,
                                    .image_count = n * n,
                                    .view_count = n,
                                    .values = WEFT_REFLECTANCE_COSINE,
                                    .distance = WEFT_FAR,
                                    .texel_pitch_mm = sqrt(across * up),
                                    .texel_aspect = fabs(across / up - 1) < 1e-6 ? 0 : across / up};
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int view = 0; view < n; view++) {
        layout->view[view] = a->direction[view];
        for (int light = 0; light < n; light++) {
            layout->light[view * n + light] = a->direction[light];
            layout->view_of_image[view * n + light] = view;
        }
    }
    return WEFT_OK;
}

static weft_code open_writer(acquisition *a, weft_error *error)
{
    weft_dataset_layout layout = {0};
    weft_code code = fill_layout(a, &layout, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_create(a->path, &layout, &a->writer, error);
    weft_dataset_layout_free(&layout);
    return code;
}

static weft_code put_light(acquisition *a, int view, int light, weft_error *error)
{
    size_t texels = (size_t)a->options->width * (size_t)a->options->height, n = (size_t)a->direction_count;
    for (size_t i = 0; i < texels; i++) {
        const float *sum = a->samples.sum + (i * n + (size_t)light) * 3;
        float batches = (float)a->samples.texel[i].batches;
        for (int channel = 0; channel < 3; channel++)
            a->image[3 * i + (size_t)channel] = weft_half_of_float(sum[channel] / batches);
    }
    return weft_dataset_writer_put_image(a->writer, view * a->direction_count + light, a->image, NULL, error);
}

static void note_view(acquisition *a, int view)
{
    size_t texels = (size_t)a->options->width * (size_t)a->options->height, n = (size_t)a->direction_count;
    double share = 1 / ((double)texels * (double)n);
    for (size_t i = 0; i < texels; i++) {
        const weft_texel_samples *texel = &a->samples.texel[i];
        double paths = (double)texel->batches * WEFT_BATCH_PATHS, covered = (double)texel->hits / paths;
        a->opacity[i * n + (size_t)view] = (float)covered;
        weft_frame_sum_merge(&a->frame[i], &texel->frame, (weft_real)(1 / paths));
        a->report->covered += covered * share;
        a->report->paths_per_texel += paths * share;
    }
    a->report->noise = fmax(a->report->noise, weft_view_samples_noise(&a->samples));
}

static weft_code put_frames(const acquisition *a, weft_error *error)
{
    size_t texels = (size_t)a->options->width * (size_t)a->options->height, bytes = 6 * texels * sizeof(float);
    float *frames = malloc(bytes);
    if (!frames)
        return weft_fail_memory(error, "frames", bytes);
    for (size_t i = 0; i < texels; i++) {
        weft_frame mean = weft_frame_of_sum(&a->frame[i]);
        const weft_vec3 axis[2] = {mean.normal, mean.tangent};
        for (size_t k = 0; k < 2; k++) {
            float *to = frames + 6 * i + 3 * k;
            to[0] = (float)axis[k].x;
            to[1] = (float)axis[k].y;
            to[2] = (float)axis[k].z;
        }
    }
    weft_code code = weft_dataset_writer_put_frames(a->writer, frames, error);
    free(frames);
    return code;
}

static weft_code acquire_views(acquisition *a, const weft_progress *progress, weft_error *error)
{
    for (int view = 0; view < a->direction_count; view++) {
        weft_progress_report(progress, "simulating views", view, a->direction_count);
        WEFT_TRY(weft_view_samples_gather(&a->samples, a->illumination, a->direction[view], view, error));
        note_view(a, view);
        for (int light = 0; light < a->direction_count; light++)
            WEFT_TRY(put_light(a, view, light, error));
    }
    weft_progress_report(progress, "simulating views", a->direction_count, a->direction_count);
    WEFT_TRY(weft_dataset_writer_put_opacity(a->writer, a->opacity, error));
    return put_frames(a, error);
}

static weft_code prepare(acquisition *a, weft_error *error)
{
    size_t texels = (size_t)a->options->width * (size_t)a->options->height;
    weft_illumination_options light = {.bounces = a->options->bounces};
    WEFT_TRY(check_request(a, error));
    WEFT_TRY(open_writer(a, error));
    WEFT_TRY(weft_illumination_create(a->stitch, a->mesh, a->direction, a->direction_count, &light, &a->illumination,
                                      error));
    WEFT_TRY(weft_view_samples_create(a->mesh, a->direction_count, a->options, &a->samples, error));
    a->image = malloc(3 * texels * sizeof *a->image);
    a->opacity = calloc(texels * (size_t)a->direction_count, sizeof *a->opacity);
    a->frame = calloc(texels, sizeof *a->frame);
    if (!a->image || !a->opacity || !a->frame)
        return weft_fail_memory(error, "images", texels * (size_t)a->direction_count * sizeof *a->opacity);
    return WEFT_OK;
}

static weft_code finish(acquisition *a, weft_error *error)
{
    errno = 0;
    char *text = provenance(a);
    weft_dataset_writer *writer = a->writer;
    a->writer = NULL;
    if (!text) {
        weft_code failure = weft_json_fail(error, WEFT_BAD_INPUT, "'%s': the name of the stitch is not UTF-8", a->path);
        weft_dataset_writer_abandon(writer);
        return failure;
    }
    weft_code code = weft_dataset_writer_finish(writer, text, error);
    free(text);
    return code;
}

weft_code weft_acquisition_mean_height(const weft_stitch *stitch, const weft_tile_mesh *mesh, double *height_mm,
                                       weft_error *error)
{
    const weft_vec3 up = {0, 0, 1};
    const weft_illumination_options light = {.bounces = 0};
    weft_illumination *illumination;
    weft_first_hit hit;
    double sum = 0;
    int seen = 0;
    WEFT_TRY(weft_illumination_create(stitch, mesh, &up, 1, &light, &illumination, error));
    for (uint32_t i = 0; i < PROBES * PROBES; i++) {
        float radiance[1][3] = {{0}};
        weft_real x = ((weft_real)(i % PROBES) + (weft_real)0.5) / PROBES * (weft_real)mesh->width;
        weft_real y = ((weft_real)(i / PROBES) + (weft_real)0.5) / PROBES * (weft_real)mesh->height;
        if (!weft_illumination_path(illumination, weft_vec3_of(x, y, (weft_real)mesh->top), up, 0, i, radiance, &hit))
            continue;
        sum += (double)(hit.at.z - (weft_real)mesh->top);
        seen++;
    }
    weft_illumination_free(illumination);
    *height_mm = seen > 0 ? fmin(sum / seen, 0) : 0;
    return WEFT_OK;
}

weft_code weft_acquire(const weft_stitch *stitch, const weft_tile_mesh *mesh, const weft_vec3 *direction,
                       int direction_count, const weft_acquisition_options *options, const char *path,
                       const weft_progress *progress, weft_acquisition_report *report, weft_error *error)
{
    *report = (weft_acquisition_report){0};
    acquisition a = {.stitch = stitch,
                     .mesh = mesh,
                     .direction = direction,
                     .direction_count = direction_count,
                     .options = options,
                     .path = path,
                     .report = report};
    weft_code code = prepare(&a, error);
    if (code == WEFT_OK)
        code = acquire_views(&a, progress, error);
    if (code == WEFT_OK)
        code = finish(&a, error);
    weft_dataset_writer_abandon(a.writer);
    weft_illumination_free(a.illumination);
    weft_view_samples_free(&a.samples);
    free(a.image);
    free(a.opacity);
    free(a.frame);
    return code;
}
