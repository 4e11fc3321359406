#include "btf/dataset/dataset.h"
#include "tests/golden/print.h"

#include <stdlib.h>

/* All texels at once: golden datasets are small. */
typedef struct texels {
    weft_half *samples;
    uint8_t *mask;
    float *opacity, *frames;
} texels;

static weft_code read_texels(weft_dataset *dataset, texels *of, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t count = (size_t)layout->width * (size_t)layout->height, images = (size_t)layout->image_count;
    of->samples = calloc(3 * count * images, sizeof *of->samples);
    of->mask = calloc(count, images);
    of->opacity = calloc(count * (size_t)layout->view_count, sizeof *of->opacity);
    of->frames = calloc(6 * count, sizeof *of->frames);
    if (!of->samples || !of->mask || !of->opacity || !of->frames)
        return weft_fail_memory(error, "texels", count);
    WEFT_TRY(weft_dataset_read_block(dataset, 0, 0, layout->width, layout->height, of->samples, of->mask, error));
    WEFT_TRY(weft_dataset_read_opacity(dataset, 0, layout->height, of->opacity, error));
    return weft_dataset_read_frames(dataset, 0, layout->height, of->frames, error);
}

static void print_layout(FILE *out, const weft_dataset_layout *layout)
{
    fprintf(out, "texels: %d x %d pitch_mm: %.9g\n", layout->width, layout->height, layout->texel_pitch_mm);
    fprintf(out, "values: %s\n", layout->values == WEFT_REFLECTANCE ? "reflectance" : "reflectance times cosine");
    fprintf(out, "lights and views: %s\n", layout->distance == WEFT_NEAR ? "positions" : "directions");
    fprintf(out, "provenance: %s\n", layout->provenance);
    for (int i = 0; i < layout->view_count; i++) {
        fprintf(out, "view %d:", i);
        print_vector(out, layout->view[i]);
        fputc('\n', out);
    }
    for (int i = 0; i < layout->image_count; i++) {
        fprintf(out, "image %d: view %d light:", i, layout->view_of_image[i]);
        print_vector(out, layout->light[i]);
        fputc('\n', out);
    }
}

/* What near lights and views come to, from the first and from the last texel. */
static void print_near_directions(FILE *out, const weft_dataset_layout *layout)
{
    for (int i = 0; i < layout->image_count; i++) {
        fprintf(out, "image %d light from:", i);
        print_vector(out, weft_dataset_light_direction(layout, i, 0, 0));
        print_vector(out, weft_dataset_light_direction(layout, i, layout->width - 1, layout->height - 1));
        fprintf(out, " view from:");
        print_vector(out, weft_dataset_view_direction(layout, layout->view_of_image[i], 0, 0));
        fputc('\n', out);
    }
}

static void print_texel(FILE *out, const weft_dataset *dataset, const texels *of, size_t texel)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t width = (size_t)layout->width, images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    fprintf(out, "texel %zu %zu\n", texel % width, texel / width);
    if (weft_dataset_has_frames(dataset)) {
        fprintf(out, "  frame:");
        for (size_t i = 0; i < 6; i++)
            fprintf(out, " %.9g", of->frames[6 * texel + i]);
        fputc('\n', out);
    }
    if (weft_dataset_has_opacity(dataset)) {
        fprintf(out, "  opacity:");
        for (size_t i = 0; i < views; i++)
            fprintf(out, " %.9g", of->opacity[texel * views + i]);
        fputc('\n', out);
    }
    for (size_t at = texel * images; at < (texel + 1) * images; at++)
        fprintf(out, "  image %zu mask %d: %.9g %.9g %.9g\n", at % images, of->mask[at],
                weft_float_of_half(of->samples[3 * at]), weft_float_of_half(of->samples[3 * at + 1]),
                weft_float_of_half(of->samples[3 * at + 2]));
}

weft_code print_dataset(const char *path, FILE *out, weft_error *error)
{
    weft_dataset *dataset;
    texels of = {0};
    WEFT_TRY(weft_dataset_open(path, &dataset, error));
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    weft_code code = read_texels(dataset, &of, error);
    if (code == WEFT_OK) {
        print_layout(out, layout);
        if (layout->distance == WEFT_NEAR)
            print_near_directions(out, layout);
        for (size_t texel = 0; texel < (size_t)layout->width * (size_t)layout->height; texel++)
            print_texel(out, dataset, &of, texel);
    }
    free(of.samples);
    free(of.mask);
    free(of.opacity);
    free(of.frames);
    weft_dataset_close(dataset);
    return code;
}
