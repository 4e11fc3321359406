#include "relief/relief.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "base/vector.h"

#include <stdio.h>

/* ---- OBJ ---- */

static void print_vertices(FILE *file, const weft_dataset_heights *heights, double width_mm, double height_mm)
{
    for (int y = 0; y < heights->height; y++) {
        double v = 1 - (y + 0.5) / heights->height;
        for (int x = 0; x < heights->width; x++) {
            double u = (x + 0.5) / heights->width;
            float z = heights->value[(size_t)y * (size_t)heights->width + (size_t)x];
            fprintf(file, "v %.6g %.6g %.6g\nvt %.6g %.6g\n", u * width_mm, v * height_mm, (double)z, u, v);
        }
    }
}

/* Anticlockwise seen from above; vertices count from 1. */
static void print_triangles(FILE *file, const weft_dataset_heights *heights)
{
    for (int y = 0; y + 1 < heights->height; y++) {
        for (int x = 0; x + 1 < heights->width; x++) {
            long a = (long)y * heights->width + x + 1, b = a + 1, c = a + heights->width, d = c + 1;
            fprintf(file, "f %ld/%ld %ld/%ld %ld/%ld\nf %ld/%ld %ld/%ld %ld/%ld\n", a, a, c, c, b, b, b, b, c, c, d, d);
        }
    }
}

weft_code weft_surface_write_obj(const char *path, const weft_dataset_heights *heights, double width_mm,
                                 double height_mm, weft_error *error)
{
    weft_atomic_file target;
    WEFT_TRY(weft_atomic_file_begin(path, &target, error));
    FILE *file = fopen(target.temporary_path, "wb");
    int failed = !file;
    if (file) {
        print_vertices(file, heights, width_mm, height_mm);
        print_triangles(file, heights);
        failed = ferror(file);
        failed |= fclose(file) != 0;
    }
    if (!failed)
        return weft_atomic_file_commit(&target, error);
    weft_code code = weft_fail_errno(error, "write", path);
    weft_atomic_file_abandon(&target);
    return code;
}

/* ---- Normals ---- */

/* The material repeats. */
static double height_of(const weft_dataset_heights *heights, int x, int y)
{
    int column = (x + heights->width) % heights->width, row = (y + heights->height) % heights->height;
    return (double)heights->value[(size_t)row * (size_t)heights->width + (size_t)column];
}

/* By central differences; rows count down. */
static weft_vec3 normal_of(const weft_dataset_heights *heights, int x, int y, double width_mm, double height_mm)
{
    double across = 2 * width_mm / heights->width, up = 2 * height_mm / heights->height;
    double slope_x = (height_of(heights, x + 1, y) - height_of(heights, x - 1, y)) / across;
    double slope_y = (height_of(heights, x, y - 1) - height_of(heights, x, y + 1)) / up;
    return weft_unit(weft_vec3_of((weft_real)-slope_x, (weft_real)-slope_y, 1));
}

weft_code weft_surface_write_normals(const char *path, const weft_dataset_heights *heights, double width_mm,
                                     double height_mm, weft_error *error)
{
    weft_image image;
    WEFT_TRY(weft_image_create(heights->width, heights->height, &image, error));
    float *pixel = image.pixels;
    for (int y = 0; y < heights->height; y++) {
        for (int x = 0; x < heights->width; x++, pixel += 3) {
            weft_vec3 normal = normal_of(heights, x, y, width_mm, height_mm);
            pixel[0] = (float)(normal.x + 1) / 2;
            pixel[1] = (float)(normal.y + 1) / 2;
            pixel[2] = (float)(normal.z + 1) / 2;
        }
    }
    weft_code code = weft_image_write(path, &image, "normals of a material", error);
    weft_image_free(&image);
    return code;
}
