/* A collection of photographs, before any is opened: which files, from where lit and seen. */
#ifndef WEFT_IMPORT_COLLECTION_H
#define WEFT_IMPORT_COLLECTION_H

#include "btf/dataset.h"
#include "btf/lines.h"

#include <stdbool.h>

typedef struct weft_photograph {
    char *name; /* of the file, relative to the folder; where it is missing, what it should be called */
    int missing;
    weft_vec3 light, view; /* directions, or positions in mm */
    weft_rgb
        intensity; /* of a near light: the pixel value of a surface with BRDF x cosine = 1 / sr at a distance of 1 mm */
} weft_photograph;

/* Freed with weft_collection_free. */
typedef struct weft_collection {
    const char *kind; /* in words, for the report */
    weft_distance distance;
    double side_mm; /* width of what a photograph shows; 0 = not said */
    int count, capacity;
    weft_photograph *photograph; /* [count] */
    weft_lines notes;
} weft_collection;

/* Recognises the kind of collection that a folder holds and lists its photographs.
 * Errors: WEFT_BAD_INPUT for a folder that holds none, or whose tables or names contradict themselves. */
weft_code weft_collection_open(const char *folder, weft_collection *collection, weft_error *error);
void weft_collection_free(weft_collection *collection);

/* Appends a photograph; `name` is copied. Errors: WEFT_SYSTEM for memory. */
weft_code weft_collection_add(weft_collection *collection, const char *name, weft_photograph photograph,
                              weft_error *error);

/* ---- One function for every kind of collection; `collection` starts empty ---- */

/* NN.png with camera_pos.txt, light_pos.txt, image_size.txt and light_power.txt. */
weft_code weft_collection_of_positions(const char *folder, weft_collection *collection, weft_error *error);
/* directions.csv with the columns file, theta_light_deg, phi_light_deg, theta_view_deg, phi_view_deg. */
weft_code weft_collection_of_table(const char *folder, weft_collection *collection, weft_error *error);
/* Photographs named by their angles, in the folder or one below. */
weft_code weft_collection_of_names(const char *folder, weft_collection *collection, weft_error *error);

/* ---- Shared by them ---- */

/* Names (relative, sorted) of the image files in a folder and the folders in it. Freed with weft_lines_free. */
weft_code weft_list_images(const char *folder, weft_lines *names, weft_error *error);

bool weft_folder_holds(const char *folder, const char *name);

/* "FOLDER/NAME" in new memory. NULL where memory is short. */
char *weft_join_path(const char *folder, const char *name);

#endif
