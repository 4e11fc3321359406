#include "base/picture/image_library.h"

#include <stddef.h>
#include <stdlib.h>

weft_code weft_picture_read(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                            weft_colour_tags *tags, weft_error *error)
{
    const weft_image_library *library;
    if (tags)
        *tags = (weft_colour_tags){0};
    WEFT_TRY(weft_image_library_open(&library, error));
    return library->picture_read(path, image, kind, exif, tags, error);
}

weft_code weft_image_read(const char *path, weft_image *image, weft_image_kind *kind, weft_error *error)
{
    return weft_picture_read(path, image, kind, NULL, NULL, error);
}

weft_code weft_exif_read(const char *path, weft_exif *exif, weft_error *error)
{
    return weft_picture_read(path, NULL, NULL, exif, NULL, error);
}

weft_code weft_image_write(const char *path, const weft_image *image, const char *description, weft_error *error)
{
    return weft_image_write_settings(path, image, description, NULL, error);
}

weft_code weft_image_write_settings(const char *path, const weft_image *image, const char *description,
                                    const char *settings, weft_error *error)
{
    const weft_image_library *library;
    if (weft_png_is_named(path))
        return weft_png_write(path, image, description, settings, error);
    WEFT_TRY(weft_image_library_open(&library, error));
    return library->image_write(path, image, description, settings, error);
}

weft_code weft_image_read_settings(const char *path, char **settings, weft_error *error)
{
    const weft_image_library *library;
    WEFT_TRY(weft_image_library_open(&library, error));
    return library->image_read_settings(path, settings, error);
}

weft_code weft_photograph_write(const char *path, int width, int height, int bits, const uint16_t *samples,
                                weft_error *error)
{
    const weft_image_library *library;
    WEFT_TRY(weft_image_library_open(&library, error));
    return library->photograph_write(path, width, height, bits, samples, error);
}

weft_code weft_photograph_read(const char *path, int width, int height, int bits, uint16_t *samples, weft_error *error)
{
    const weft_image_library *library;
    WEFT_TRY(weft_image_library_open(&library, error));
    return library->photograph_read(path, width, height, bits, samples, error);
}

weft_code weft_snapshot_write(const char *path, const weft_image *image, const weft_camera_notes *notes,
                              weft_error *error)
{
    const weft_image_library *library;
    WEFT_TRY(weft_image_library_open(&library, error));
    return library->snapshot_write(path, image, notes, error);
}

void weft_colour_tags_free(weft_colour_tags *tags)
{
    free(tags->profile);
    *tags = (weft_colour_tags){0};
}
