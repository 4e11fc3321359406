/* How collections of photographs lie on disk: one reader for every kind, and the choice among them. */
#ifndef WEFT_IMPORT_READERS_H
#define WEFT_IMPORT_READERS_H

#include "import/bonn/file.h"
#include "import/collection.h"

/* Recognises the kind of collection that a folder holds and lists its photographs; with a list of
 * lamps `lights` (else NULL) it is one of photographs from one place. Of photographs with the
 * same light and view one is kept where `leaves_out_doubles`. The caller frees with weft_collection_free. Errors:
 * WEFT_BAD_INPUT for a folder that holds none, or whose tables or names contradict themselves. */
weft_code weft_collection_open(const char *folder, const char *lights, bool leaves_out_doubles,
                               weft_collection *collection, weft_error *error);

/* ---- One function for every kind of collection; `collection` starts empty ---- */

/* NN.png with camera_pos.txt, light_pos.txt, image_size.txt and light_power.txt. */
weft_code weft_collection_of_positions(const char *folder, weft_collection *collection, weft_error *error);
/* directions.csv with the columns file, theta_light_deg, phi_light_deg, theta_view_deg, phi_view_deg. */
weft_code weft_collection_of_table(const char *folder, weft_collection *collection, weft_error *error);
/* One view, and a list of the direction of the lamp of every photograph: `lights`, or the .lp file in the folder. */
weft_code weft_collection_of_lights(const char *folder, const char *lights, weft_collection *collection,
                                    weft_error *error);
/* Photographs named by their angles, in the folder or one below. */
weft_code weft_collection_of_names(const char *folder, weft_collection *collection, weft_error *error);

/* The images of a file of Bonn, `path`, which must stay open while they are made. */
weft_code weft_collection_of_bonn(const char *path, const weft_bonn_file *file, weft_collection *collection,
                                  weft_error *error);

/* The path of an .lp file in the folder, in new memory, NULL where there is none, and how many there are. Errors:
 * WEFT_SYSTEM. */
weft_code weft_light_list_in(const char *folder, char **path, int *count, weft_error *error);

#endif
