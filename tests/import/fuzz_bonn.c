#include "base/integers.h"
#include "import/bonn/images.h"
#include "tests/support/fuzz.h"
#include "tests/support/scratch_folder.h"

#include <stdlib.h>

void fuzz_write_seed(const char *path)
{
    size_t size;
    unsigned char *bytes = scratch_load(WEFT_SEED, &size);
    scratch_store(path, bytes, size);
    free(bytes);
}

static void make_images(const weft_bonn_file *file)
{
    weft_image image[WEFT_BONN_GROUP] = {{0}};
    int number[WEFT_BONN_GROUP], last = file->view_count * file->light_count - 1;
    int count = weft_bonn_group_size(file);
    weft_code code = WEFT_OK;
    for (int i = 0; code == WEFT_OK && i < count; i++) {
        number[i] = weft_larger(last - i, 0);
        code = weft_image_create(file->width, file->height, &image[i], NULL);
    }
    if (code == WEFT_OK)
        weft_bonn_images_make(file, number, count, image, NULL);
    for (int i = 0; i < count; i++)
        weft_image_free(&image[i]);
}

static void average_frames(const weft_bonn_file *file)
{
    float frames[6];
    if (file->frame)
        weft_bonn_frames_average(file, 1, 1, frames);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_bonn_file file;
    weft_error error = {0};
    weft_code code = weft_bonn_file_open(fuzz_file(bytes, size), &file, &error);
    if (code != WEFT_OK && (error.code != code || weft_class_of(code) != WEFT_BAD_INPUT || !error.message[0]))
        abort();
    if (code != WEFT_OK)
        return 0;
    make_images(&file);
    average_frames(&file);
    weft_bonn_file_close(&file);
    return 0;
}
