#include "base/picture/image_library.h"

#include "base/atomic_file.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct encoder {
    png_structp png;
    png_infop info;
    png_bytep row;
    char *bytes; /* what is written so far */
    size_t size;
    FILE *stream;
    char said[120]; /* by libpng */
} encoder;

bool weft_png_is_named(const char *path)
{
    size_t length = strlen(path);
    return length >= 4 && strcasecmp(path + length - 4, ".png") == 0;
}

static void on_error(png_structp png, const char *message)
{
    encoder *e = png_get_error_ptr(png);
    snprintf(e->said, sizeof e->said, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, const char *message)
{
    (void)png;
    (void)message;
}

static void on_write(png_structp png, png_bytep bytes, size_t size)
{
    encoder *e = png_get_io_ptr(png);
    if (fwrite(bytes, 1, size, e->stream) != size)
        png_error(png, "no memory");
}

static void on_flush(png_structp png)
{
    (void)png;
}

static void put_text(encoder *e, char *key, const char *text)
{
    if (!text)
        return;
    png_text entry = {.compression = PNG_TEXT_COMPRESSION_NONE, .key = key, .text = (char *)text};
    png_set_text(e->png, e->info, &entry, 1);
}

/* Nothing and what is no number are black. */
static png_byte byte_of(float value)
{
    return value > 0 ? (png_byte)(value < 1 ? value * 255 + 0.5F : 255) : 0;
}

static void put_rows(encoder *e, const weft_image *image)
{
    size_t count = 3 * (size_t)image->width;
    for (int y = 0; y < image->height; y++) {
        for (size_t i = 0; i < count; i++)
            e->row[i] = byte_of(image->pixels[(size_t)y * count + i]);
        png_write_row(e->png, e->row);
    }
}

/* libpng comes back here by a jump: what changes in between lives in the encoder. */
static bool encode(encoder *e, const weft_image *image, const char *description, const char *settings)
{
    if (setjmp(png_jmpbuf(e->png)))
        return false;
    png_set_write_fn(e->png, e, on_write, on_flush);
    png_set_IHDR(e->png, e->info, (png_uint_32)image->width, (png_uint_32)image->height, 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(e->png, e->info, PNG_sRGB_INTENT_PERCEPTUAL);
    put_text(e, "Description", description);
    put_text(e, WEFT_PNG_SETTINGS, settings);
    png_write_info(e->png, e->info);
    put_rows(e, image);
    png_write_end(e->png, NULL);
    return true;
}

static bool start(encoder *e, int width)
{
    e->stream = open_memstream(&e->bytes, &e->size);
    e->row = malloc(3 * (size_t)width);
    e->png = png_create_write_struct(PNG_LIBPNG_VER_STRING, e, on_error, on_warning);
    e->info = e->png ? png_create_info_struct(e->png) : NULL;
    return e->stream && e->row && e->info;
}

static void stop(encoder *e)
{
    png_destroy_write_struct(&e->png, &e->info);
    free(e->row);
    free(e->bytes);
}

weft_code weft_png_write(const char *path, const weft_image *image, const char *description, const char *settings,
                         weft_error *error)
{
    encoder e = {0};
    weft_code code = WEFT_OK;
    bool started = start(&e, image->width);
    if (started && !encode(&e, image, description, settings))
        code = weft_fail(error, WEFT_SYSTEM, "cannot write image '%s': %s", path, e.said);
    /* The last of the bytes may find no memory. */
    bool closed = e.stream && fclose(e.stream) == 0;
    if (code == WEFT_OK)
        code = started && closed ? weft_write_file(path, e.bytes, e.size, error)
                                 : weft_fail_memory(error, path, 3 * (size_t)image->width * (size_t)image->height);
    stop(&e);
    return code;
}
