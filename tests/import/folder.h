/* Small collections of photographs, made for one test and removed after it. */
#ifndef WEFT_TESTS_IMPORT_FOLDER_H
#define WEFT_TESTS_IMPORT_FOLDER_H

#include "base/picture/image.h"
#include "btf/dataset/dataset.h"
#include "weft/import.h"

/* A new empty folder in the working directory; `dataset` is where an import may go. */
typedef struct test_folder {
    char path[64];
    char dataset[80];
} test_folder;

test_folder folder_make(void);
void folder_remove(const test_folder *folder);

/* Writes FOLDER/NAME, making the folder in between if there is one. */
void folder_put_image(const test_folder *folder, const char *name, const weft_image *image);
void folder_put_grey(const test_folder *folder, const char *name, int width, int height, float value);
void folder_put_text(const test_folder *folder, const char *name, const char *text);
/* Cuts a file to half its length. */
void folder_truncate(const test_folder *folder, const char *name);

/* Imports the folder; the message of a failure goes to `error`. */
weft_code folder_import(const test_folder *folder, const weft_import_options *options, weft_error *error);

/* The imported dataset, read whole: samples [height][width][image_count][3], mask [height][width][image_count]. */
typedef struct imported {
    weft_dataset *dataset;
    const weft_dataset_layout *layout;
    weft_half *samples;
    uint8_t *mask;
} imported;

imported folder_open(const test_folder *folder);
void imported_close(imported *import);
float imported_sample(const imported *import, int x, int y, int image, int channel);
uint8_t imported_mask(const imported *import, int x, int y, int image);
/* The image with this light and view (degrees); fails the test where there is none. */
int imported_image(const imported *import, double tl, double pl, double tv, double pv);

#endif
