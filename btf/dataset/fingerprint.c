#include "btf/dataset/fingerprint.h"
#include "base/text/json_text.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { PROBES = 4 }; /* along each side */

/* Even weights are the same as none. */
static bool has_uneven_weights(const weft_dataset_layout *layout)
{
    const double *weight = layout->figure[WEFT_IMAGE_WEIGHT];
    bool uneven = false;
    for (int i = 0; weight && i < layout->image_count; i++)
        uneven = uneven || weight[i] != weight[0];
    return uneven;
}

static uint32_t layout_checksum(const weft_dataset_layout *layout)
{
    const int32_t numbers[6] = {layout->width,      layout->height,          layout->image_count,
                                layout->view_count, (int32_t)layout->values, (int32_t)layout->distance};
    size_t images = (size_t)layout->image_count, views = (size_t)layout->view_count;
    uLong checksum = crc32_z(0, (const Bytef *)numbers, sizeof numbers);
    checksum = crc32_z(checksum, (const Bytef *)&layout->texel_pitch_mm, sizeof layout->texel_pitch_mm);
    checksum = crc32_z(checksum, (const Bytef *)layout->light, images * sizeof *layout->light);
    checksum = crc32_z(checksum, (const Bytef *)layout->view, views * sizeof *layout->view);
    checksum = crc32_z(checksum, (const Bytef *)layout->view_of_image, images * sizeof *layout->view_of_image);
    if (has_uneven_weights(layout))
        checksum = crc32_z(checksum, (const Bytef *)layout->figure[WEFT_IMAGE_WEIGHT], images * sizeof(double));
    return (uint32_t)checksum;
}

/* The centre of the nth of PROBES parts of a side. */
static int probe(int side, int n)
{
    return (int)((2 * (long)n + 1) * side / (2 * PROBES));
}

weft_code weft_dataset_fingerprint_take(weft_dataset *dataset, weft_dataset_fingerprint *fingerprint, weft_error *error)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(dataset);
    size_t images = (size_t)layout->image_count;
    weft_half *samples = malloc(3 * images * sizeof *samples);
    uint8_t *mask = malloc(images);
    weft_code code = samples && mask ? WEFT_OK : weft_fail_memory(error, "samples of a texel", 7 * images);
    uLong checksum = 0;
    for (int i = 0; code == WEFT_OK && i < PROBES * PROBES; i++) {
        code = weft_dataset_read_block(dataset, probe(layout->width, i % PROBES), probe(layout->height, i / PROBES), 1,
                                       1, samples, mask, error);
        if (code == WEFT_OK) {
            checksum = crc32_z(checksum, (const Bytef *)samples, 3 * images * sizeof *samples);
            checksum = crc32_z(checksum, mask, images);
        }
    }
    *fingerprint = (weft_dataset_fingerprint){layout_checksum(layout), (uint32_t)checksum};
    free(samples);
    free(mask);
    return code;
}

void weft_checksum_print(uint32_t checksum, char text[WEFT_CHECKSUM_TEXT])
{
    snprintf(text, WEFT_CHECKSUM_TEXT, "%08" PRIx32, checksum);
}

static bool is_another(const json_t *origin, const char *key, uint32_t checksum)
{
    char text[WEFT_CHECKSUM_TEXT];
    const char *said = json_string_value(json_object_get(origin, key));
    weft_checksum_print(checksum, text);
    return said && strcmp(said, text) != 0;
}

weft_code weft_dataset_fingerprint_compare(weft_dataset *dataset, const char *metadata, char warning[WEFT_MESSAGE_SIZE],
                                           weft_error *error)
{
    weft_dataset_fingerprint own;
    warning[0] = '\0';
    json_t *object = NULL;
    if (metadata)
        WEFT_TRY(weft_json_parse(metadata, strlen(metadata), 0, "metadata", &object, error));
    json_t *origin = json_object_get(object, "dataset");
    if (json_object_get(object, "tile")) {
        snprintf(warning, WEFT_MESSAGE_SIZE,
                 "the material was cut to tile: its texels lie elsewhere than those of '%s'",
                 weft_dataset_path(dataset));
        origin = NULL;
    }
    weft_code code = origin ? weft_dataset_fingerprint_take(dataset, &own, error) : WEFT_OK;
    if (origin && code == WEFT_OK) {
        bool layout = is_another(origin, "layout", own.layout), samples = is_another(origin, "samples", own.samples);
        if (layout || samples)
            snprintf(warning, WEFT_MESSAGE_SIZE, "the material was not made from this '%s': %s differ",
                     weft_dataset_path(dataset), layout ? "sizes, lights or views" : "the samples");
    }
    json_decref(object);
    return code;
}
