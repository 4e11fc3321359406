/* A collection of photographs, before any is opened: which files, from where lit and seen. */
#ifndef WEFT_IMPORT_COLLECTION_H
#define WEFT_IMPORT_COLLECTION_H

#include "base/text/lines.h"
#include "btf/dataset/dataset.h"

#include <stdbool.h>

typedef struct weft_photograph {
    char *name; /* of the file, relative to the folder; where it is missing, what it should be called */
    int missing;
    int number;            /* of an image in one file of many: its place there */
    weft_vec3 light, view; /* directions, or positions in mm */
    /* Of a near light: the pixel value of a surface with BRDF x cosine = 1 / sr at a distance of 1 mm. */
    weft_rgb intensity;
} weft_photograph;

/* Freed with weft_collection_free. */
typedef struct weft_collection {
    const char *kind;        /* in words, for the report */
    bool leaves_out_doubles; /* of photographs of one light and view all but one; else they are an error */
    weft_distance distance;
    weft_values values; /* of a far light: what the collection says of itself */
    double side_mm;     /* width of what a photograph shows; 0 = not said */
    int count, capacity;
    weft_photograph *photograph; /* [count] */
    weft_lines notes;
} weft_collection;

void weft_collection_free(weft_collection *collection);

/* Appends a photograph; `name` is copied. Errors: WEFT_SYSTEM for memory. */
weft_code weft_collection_add(weft_collection *collection, const char *name, weft_photograph photograph,
                              weft_error *error);

/* Whether there is a file of that name in the folder. */
bool weft_folder_holds(const char *folder, const char *name);

/* Whether two files of the folder can be read and hold the same bytes. */
bool weft_folder_holds_copies(const char *folder, const char *name, const char *other);

/* "FOLDER/NAME" in new memory. NULL where memory is short. */
char *weft_join_path(const char *folder, const char *name);

#endif
