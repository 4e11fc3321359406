#include "btf/dataset/scratch.h"

#include "btf/dataset/dataset.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const size_t bytes_per_texel = 3 * sizeof(weft_half) + 1;

static off_t image_bytes(const weft_scratch *scratch)
{
    return (off_t)scratch->width * scratch->height * (off_t)bytes_per_texel;
}

/* Samples of an image come first, then its mask. */
static off_t samples_offset(const weft_scratch *scratch, int image, int x, int y)
{
    return image * image_bytes(scratch) + ((off_t)y * scratch->width + x) * (off_t)(3 * sizeof(weft_half));
}

static off_t mask_offset(const weft_scratch *scratch, int image, int x, int y)
{
    return samples_offset(scratch, image, 0, scratch->height) + (off_t)y * scratch->width + x;
}

/* A file without a name in the folder of `path`; where the file system has none, a temporary name removed at once. */
static int open_nameless(const char *path)
{
    char copy[PATH_MAX], name[PATH_MAX + 32];
    snprintf(copy, sizeof copy, "%s", path);
    const char *folder = dirname(copy);
    int descriptor = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0)
        return descriptor;
    snprintf(name, sizeof name, "%s/.weft-scratch-XXXXXX", folder);
    descriptor = mkostemp(name, O_CLOEXEC);
    if (descriptor >= 0)
        unlink(name);
    return descriptor;
}

static weft_code reserve(const weft_scratch *scratch, int image_count, weft_error *error)
{
    off_t size = image_count * image_bytes(scratch);
    int failure = posix_fallocate(scratch->descriptor, 0, size);
    if (failure == 0)
        return WEFT_OK;
    return weft_fail(error, WEFT_SYSTEM, "cannot reserve %lld bytes of scratch space beside '%s': %s", (long long)size,
                     scratch->path, strerror(failure));
}

weft_code weft_scratch_create(const char *path, int width, int height, int image_count, weft_scratch *scratch,
                              weft_error *error)
{
    *scratch = (weft_scratch){.path = path, .descriptor = open_nameless(path), .width = width, .height = height};
    if (scratch->descriptor < 0)
        return weft_fail_errno(error, "create a scratch file beside", path);
    scratch->present = calloc((size_t)image_count, sizeof *scratch->present);
    weft_code code = scratch->present ? reserve(scratch, image_count, error)
                                      : weft_fail_memory(error, "list of images", (size_t)image_count);
    if (code != WEFT_OK)
        weft_scratch_free(scratch);
    return code;
}

void weft_scratch_free(weft_scratch *scratch)
{
    if (scratch->descriptor >= 0)
        close(scratch->descriptor);
    free(scratch->present);
    *scratch = (weft_scratch){.descriptor = -1};
}

static weft_code write_at(const weft_scratch *scratch, const void *bytes, size_t size, off_t offset, weft_error *error)
{
    for (const char *at = bytes; size > 0;) {
        ssize_t written = pwrite(scratch->descriptor, at, size, offset);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return weft_fail_errno(error, "write the scratch file of", scratch->path);
        at += written;
        offset += written;
        size -= (size_t)written;
    }
    return WEFT_OK;
}

static weft_code read_at(const weft_scratch *scratch, void *bytes, size_t size, off_t offset, weft_error *error)
{
    for (char *at = bytes; size > 0;) {
        ssize_t got = pread(scratch->descriptor, at, size, offset);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return weft_fail_errno(error, "read the scratch file of", scratch->path);
        at += got;
        offset += got;
        size -= (size_t)got;
    }
    return WEFT_OK;
}

static bool is_finite(weft_half half)
{
    return (half & 0x7c00) != 0x7c00;
}

static bool is_lower_bound(const weft_half rgb[3])
{
    bool is = true;
    for (int c = 0; c < 3; c++)
        is = is && is_finite(rgb[c]) && weft_float_of_half(rgb[c]) >= 0;
    return is;
}

/* Clears samples under a mask, except for what is but saturated. */
static weft_code clean(const weft_scratch *scratch, int image, weft_half *samples, const uint8_t *mask,
                       weft_error *error)
{
    size_t width = (size_t)scratch->width, count = width * (size_t)scratch->height;
    for (size_t i = 0; i < count; i++) {
        weft_half *rgb = samples + 3 * i;
        if (mask && mask[i]) {
            if (mask[i] != WEFT_MASK_SATURATED || !is_lower_bound(rgb))
                memset(rgb, 0, 3 * sizeof *rgb);
        } else if (!is_finite(rgb[0]) || !is_finite(rgb[1]) || !is_finite(rgb[2]))
            return weft_fail(error, WEFT_BAD_INPUT, "'%s': image %d, texel (%zu, %zu): a valid sample is not finite",
                             scratch->path, image, i % width, i / width);
    }
    return WEFT_OK;
}

weft_code weft_scratch_put(weft_scratch *scratch, int image, const weft_half *samples, const uint8_t *mask,
                           weft_error *error)
{
    size_t size = (size_t)image_bytes(scratch), texels = (size_t)scratch->width * (size_t)scratch->height;
    char *record = calloc(1, size);
    if (!record)
        return weft_fail_memory(error, "image", size);
    size_t sample_bytes = texels * 3 * sizeof *samples;
    memcpy(record, samples, sample_bytes);
    if (mask)
        memcpy(record + sample_bytes, mask, texels);
    weft_code code = clean(scratch, image, (weft_half *)record, mask, error);
    if (code == WEFT_OK)
        code = write_at(scratch, record, size, samples_offset(scratch, image, 0, 0), error);
    scratch->present[image] = code == WEFT_OK;
    free(record);
    return code;
}

weft_code weft_scratch_take(const weft_scratch *scratch, int image, int x, int y, int width, int height,
                            weft_half *samples, uint8_t *mask, weft_error *error)
{
    size_t texels = (size_t)width * (size_t)height;
    if (!scratch->present[image]) {
        memset(samples, 0, texels * 3 * sizeof *samples);
        memset(mask, WEFT_MASK_MISSING, texels);
        return WEFT_OK;
    }
    bool is_whole_rows = width == scratch->width;
    int strips = is_whole_rows ? 1 : height;
    size_t strip = texels / (size_t)strips;
    for (int i = 0; i < strips; i++) {
        off_t at = samples_offset(scratch, image, x, y + i), mask_at = mask_offset(scratch, image, x, y + i);
        WEFT_TRY(read_at(scratch, samples + 3 * strip * (size_t)i, strip * 3 * sizeof *samples, at, error));
        WEFT_TRY(read_at(scratch, mask + strip * (size_t)i, strip, mask_at, error));
    }
    return WEFT_OK;
}
