#include "compress/hold_out/texel_subset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- The surface ---- */

/* The places above the texels of the block. */
static weft_code crop_surface(const weft_texel_subset *subset, weft_dataset_heights *cropped, weft_error *error)
{
    const weft_dataset_heights *whole = &subset->surface;
    const weft_predicted_window *window = &subset->window;
    int across = whole->width / window->whole_width, down = whole->height / window->whole_height;
    *cropped = (weft_dataset_heights){.width = across * subset->layout.width,
                                      .height = down * subset->layout.height,
                                      .level_count = whole->level_count};
    size_t row = (size_t)cropped->width;
    cropped->value = malloc(row * (size_t)cropped->height * sizeof *cropped->value);
    if (!cropped->value)
        return weft_fail_memory(error, "heights", row * (size_t)cropped->height * sizeof *cropped->value);
    for (size_t y = 0; y < (size_t)cropped->height; y++)
        memcpy(cropped->value + y * row,
               whole->value + ((size_t)(down * window->y) + y) * (size_t)whole->width + (size_t)(across * window->x),
               row * sizeof *cropped->value);
    return WEFT_OK;
}

/* A dataset refuses what lies further from it than it is wide. */
static bool is_too_deep(const weft_texel_subset *subset)
{
    double size_mm[2], most = 0;
    weft_dataset_size_mm(&subset->layout, size_mm);
    for (size_t i = 0; i < (size_t)subset->surface.width * (size_t)subset->surface.height; i++)
        most = fmax(most, fabs((double)subset->surface.value[i]));
    return most > fmin(size_mm[0], size_mm[1]);
}

static weft_code put_surface(const weft_texel_subset *subset, weft_dataset_writer *writer, weft_error *error)
{
    weft_dataset_heights cropped;
    weft_code code = crop_surface(subset, &cropped, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_put_heights(writer, &cropped, error);
    weft_dataset_heights_free(&cropped);
    return code;
}

/* ---- Without some images ---- */

/* The images and views that are kept, by their number in the subset. */
typedef struct kept_images {
    int image_count, view_count;
    int *image, *view; /* [image_count], [view_count] */
    int *view_index;   /* by view of the subset: its place among those that are kept, or -1 */
} kept_images;

static void free_kept(kept_images *kept)
{
    free(kept->image);
    free(kept->view);
    free(kept->view_index);
}

static weft_code find_kept(const weft_dataset_layout *layout, const uint8_t *held_out, kept_images *kept,
                           weft_error *error)
{
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    *kept = (kept_images){.image = calloc(images, sizeof *kept->image),
                          .view = calloc(views, sizeof *kept->view),
                          .view_index = calloc(views, sizeof *kept->view_index)};
    if (!kept->image || !kept->view || !kept->view_index)
        return weft_fail_memory(error, "images", (images + 2 * views) * sizeof *kept->image);
    for (int i = 0; i < layout->image_count; i++) {
        if (held_out[i])
            continue;
        kept->image[kept->image_count++] = i;
        kept->view_index[layout->view_of_image[i]] = 1;
    }
    for (int view = 0; view < layout->view_count; view++) {
        if (kept->view_index[view])
            kept->view[kept->view_count] = view;
        kept->view_index[view] = kept->view_index[view] ? kept->view_count++ : -1;
    }
    return WEFT_OK;
}

static weft_code make_kept_layout(const weft_dataset_layout *source, const kept_images *kept,
                                  weft_dataset_layout *layout, weft_error *error)
{
    *layout = *source;
    layout->image_count = kept->image_count;
    layout->view_count = kept->view_count;
    WEFT_TRY(weft_dataset_layout_allocate(layout, error));
    for (int i = 0; i < kept->image_count; i++) {
        layout->light[i] = source->light[kept->image[i]];
        layout->view_of_image[i] = kept->view_index[source->view_of_image[kept->image[i]]];
    }
    for (int view = 0; view < kept->view_count; view++)
        layout->view[view] = source->view[kept->view[view]];
    const double *weight = source->figure[WEFT_IMAGE_WEIGHT];
    if (!weight)
        return WEFT_OK;
    WEFT_TRY(weft_dataset_layout_allocate_figure(layout, WEFT_IMAGE_WEIGHT, error));
    for (int i = 0; i < kept->image_count; i++)
        layout->figure[WEFT_IMAGE_WEIGHT][i] = weight[kept->image[i]];
    return WEFT_OK;
}

static weft_code put_images(const weft_texel_subset *subset, const kept_images *kept, weft_dataset_writer *writer,
                            weft_error *error)
{
    size_t texels = (size_t)subset->layout.width * (size_t)subset->layout.height;
    size_t images = (size_t)subset->layout.image_count;
    weft_half *samples = malloc(3 * texels * sizeof *samples);
    uint8_t *mask = malloc(texels);
    weft_code code = samples && mask ? WEFT_OK : weft_fail_memory(error, "image", 7 * texels);
    for (int i = 0; code == WEFT_OK && i < kept->image_count; i++) {
        for (size_t texel = 0; texel < texels; texel++) {
            size_t at = texel * images + (size_t)kept->image[i];
            memcpy(samples + 3 * texel, subset->samples + 3 * at, 3 * sizeof *samples);
            mask[texel] = subset->mask[at];
        }
        code = weft_dataset_writer_put_image(writer, i, samples, mask, error);
    }
    free(samples);
    free(mask);
    return code;
}

static weft_code put_opacity(const weft_texel_subset *subset, const kept_images *kept, weft_dataset_writer *writer,
                             weft_error *error)
{
    size_t texels = (size_t)subset->layout.width * (size_t)subset->layout.height;
    size_t views = (size_t)kept->view_count, all = (size_t)subset->layout.view_count;
    float *opacity = malloc(texels * views * sizeof *opacity);
    if (!opacity)
        return weft_fail_memory(error, "opacity", texels * views * sizeof *opacity);
    for (size_t i = 0; i < texels * views; i++)
        opacity[i] = subset->opacity[i / views * all + (size_t)kept->view[i % views]];
    weft_code code = weft_dataset_writer_put_opacity(writer, opacity, error);
    free(opacity);
    return code;
}

static weft_code put_all(const weft_texel_subset *subset, const kept_images *kept, weft_dataset_writer *writer,
                         weft_error *error)
{
    WEFT_TRY(put_images(subset, kept, writer, error));
    if (subset->opacity)
        WEFT_TRY(put_opacity(subset, kept, writer, error));
    return subset->frames ? weft_dataset_writer_put_frames(writer, subset->frames, error) : WEFT_OK;
}

/* A plane is one height, which is not cropped. */
static bool is_plane(const weft_dataset_heights *surface)
{
    return surface->width == 1 && surface->height == 1;
}

static weft_code write_kept(const weft_texel_subset *subset, const kept_images *kept, bool with_surface,
                            const char *path, weft_error *error)
{
    weft_dataset_layout layout = {0};
    weft_dataset_writer *writer = NULL;
    weft_code code = make_kept_layout(&subset->layout, kept, &layout, error);
    if (with_surface && is_plane(&subset->surface))
        layout.plane_mm = (double)subset->surface.value[0];
    if (code == WEFT_OK)
        code = weft_dataset_writer_create(path, &layout, &writer, error);
    if (code == WEFT_OK)
        code = put_all(subset, kept, writer, error);
    if (code == WEFT_OK && with_surface && !is_plane(&subset->surface))
        code = put_surface(subset, writer, error);
    if (code == WEFT_OK)
        code = weft_dataset_writer_finish(writer, NULL, error);
    else
        weft_dataset_writer_abandon(writer);
    weft_dataset_layout_free(&layout);
    return code;
}

static weft_code write_and_open(const weft_texel_subset *subset, const uint8_t *held_out, bool with_surface,
                                const char *path, weft_dataset **result, weft_error *error)
{
    kept_images kept;
    weft_code code = find_kept(&subset->layout, held_out, &kept, error);
    if (code == WEFT_OK)
        code = write_kept(subset, &kept, with_surface, path, error);
    if (code == WEFT_OK) {
        code = weft_dataset_open(path, result, error);
        unlink(path);
    }
    free_kept(&kept);
    return code;
}

weft_code weft_texel_subset_write(const weft_texel_subset *subset, const uint8_t *held_out, const char *path,
                                  weft_dataset **result, weft_error *error)
{
    return write_and_open(subset, held_out, false, path, result, error);
}

weft_code weft_texel_subset_write_with_surface(const weft_texel_subset *subset, const uint8_t *held_out,
                                               const char *path, weft_dataset **result, weft_error *error)
{
    bool has_surface = weft_texel_subset_has_surface(subset) && !is_too_deep(subset);
    return write_and_open(subset, held_out, has_surface, path, result, error);
}
