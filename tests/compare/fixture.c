#include "tests/compare/fixture.h"

#include "btf/direction/direction.h"

#include <math.h>
#include <stdlib.h>

static void put_image(weft_dataset_writer *writer, const weft_dataset_layout *layout, int image,
                      fixture_reflectance reflectance, fixture_mask masked)
{
    uint32_t random = 2654435761u * (uint32_t)(image + 1);
    size_t texels = (size_t)layout->width * (size_t)layout->height;
    weft_half *samples = malloc(3 * texels * sizeof *samples);
    uint8_t *mask = calloc(texels, 1);
    for (int i = 0; i < (int)texels; i++) {
        int x = i % layout->width, y = i / layout->width;
        weft_vec3 light = weft_dataset_light_direction(layout, image, x, y);
        weft_vec3 view = weft_dataset_view_direction(layout, layout->view_of_image[image], x, y);
        weft_rgb value = reflectance(x, y, light, view);
        samples[3 * i] = weft_half_of_float((float)(value.r * light.z));
        samples[3 * i + 1] = weft_half_of_float((float)(value.g * light.z));
        samples[3 * i + 2] = weft_half_of_float((float)(value.b * light.z));
        random = random * 1664525u + 1013904223u;
        if (masked == FIXTURE_MASK_FIFTH ? (random >> 16) % 5 == 0 : masked == FIXTURE_MASK_ONE && image + i == 0)
            mask[i] = WEFT_MASK_SATURATED;
    }
    weft_error error = {0};
    expect_ok(weft_dataset_writer_put_image(writer, image, samples, mask, &error), &error);
    free(samples);
    free(mask);
}

static void write_dataset(const char *path, weft_dataset_layout *layout, fixture_reflectance reflectance,
                          fixture_mask masked)
{
    weft_error error = {0};
    weft_dataset_writer *writer;
    expect_ok(weft_dataset_writer_create(path, layout, &writer, &error), &error);
    for (int i = 0; i < layout->image_count; i++)
        put_image(writer, layout, i, reflectance, masked);
    expect_ok(weft_dataset_writer_finish(writer, "{\"source\":\"fixture\"}", &error), &error);
    weft_dataset_layout_free(layout);
}

void fixture_far_dataset(const char *path, int width, int height, int ring_count, fixture_reflectance reflectance,
                         fixture_mask masked)
{
    static const int directions_within[] = {0, 1, 7, 19, 37, 57, 81};
    int count = directions_within[ring_count];
    weft_dataset_layout layout = {.width = width,
                                  .height = height,
                                  .image_count = count * count,
                                  .view_count = count,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = WEFT_FAR,
                                  .texel_pitch_mm = 1};
    weft_error error = {0};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int v = 0; v < count; v++) {
        layout.view[v] = weft_direction_of_angles(weft_ubo81_angles(v));
        for (int l = 0; l < count; l++) {
            layout.light[v * count + l] = weft_direction_of_angles(weft_ubo81_angles(l));
            layout.view_of_image[v * count + l] = v;
        }
    }
    write_dataset(path, &layout, reflectance, masked);
}

void fixture_near_dataset(const char *path, int size, int image_count, fixture_reflectance reflectance)
{
    weft_dataset_layout layout = {.width = size,
                                  .height = size,
                                  .image_count = image_count,
                                  .view_count = image_count,
                                  .values = WEFT_REFLECTANCE_COSINE,
                                  .distance = WEFT_NEAR,
                                  .texel_pitch_mm = 64.0 / size};
    weft_error error = {0};
    expect_ok(weft_dataset_layout_allocate(&layout, &error), &error);
    for (int i = 0; i < image_count; i++) {
        double turn = 2 * WEFT_PI * i / image_count;
        layout.light[i] = layout.view[i] = weft_vec3_of(40 * cos(turn), 40 * sin(turn), 150 + 2 * i);
        layout.view_of_image[i] = i;
    }
    write_dataset(path, &layout, reflectance, 0);
}

void fixture_diffuse_material(const char *path, int width, int height, weft_rgb (*value)(int x, int y))
{
    weft_material material;
    weft_error error = {0};
    expect_ok(weft_material_create(width, height, 0, 0, 0, 0, &material, &error), &error);
    material.texel_pitch_mm = 1;
    for (int i = 0; i < width * height; i++) {
        weft_rgb rho = value(i % width, i / width);
        const double channel[3] = {rho.r, rho.g, rho.b};
        for (int c = 0; c < 3; c++)
            material.level[0].diffuse[4 * i + c] = weft_half_of_float((float)channel[c]);
    }
    expect_ok(weft_material_write(path, &material, &error), &error);
    weft_material_free(&material);
}

fixture_weave fixture_cloth;

weft_rgb fixture_woven(int x, int y, weft_vec3 light, weft_vec3 view)
{
    enum { POINTS = 4 };
    weft_rgb sum = {0};
    for (int i = 0; i < POINTS * POINTS; i++) {
        double U = (x + (i % POINTS + 0.5) / POINTS - fixture_cloth.left) / fixture_cloth.width;
        double V = 1 - (y + (i / POINTS + 0.5) / POINTS - fixture_cloth.top) / fixture_cloth.height;
        weft_weave_point point = weft_weave_locate(&fixture_cloth.weave, U, V, 0);
        weft_rgb value = weft_weave_brdf(&fixture_cloth.weave, &point, light, view);
        sum.r += value.r, sum.g += value.g, sum.b += value.b;
    }
    double scale = WEFT_PI / (POINTS * POINTS);
    return (weft_rgb){scale * sum.r, scale * sum.g, scale * sum.b};
}
