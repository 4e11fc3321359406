/* The folder of photographs: which there are, and which have the size that most have. */
#ifndef WEFT_REGISTRATION_HAND_FOLDER_H
#define WEFT_REGISTRATION_HAND_FOLDER_H

#include "registration/hand/hand.h"

/* Fewer photographs than this make no material. */
enum { WEFT_HAND_FEWEST = 3 };

/* Fills an empty `hand` with the photographs of a folder, their names and what the camera wrote of them. One that
 * cannot be read, or has another size than most, gets a remark. The caller frees `hand` with weft_hand_free, also after
 * an error. Errors: WEFT_BAD_INPUT where there are too few, or none can be read; WEFT_SYSTEM. Uses OpenMP. */
weft_code weft_hand_list(const char *folder, weft_hand *hand, weft_error *error);

/* Of a photograph of the size that most of those in use have; NULL where none is in use. Pure. */
const weft_exif *weft_hand_common_size(const weft_hand *hand);

#endif
