/* What a list tells of lamps and views, held against what the photographs tell. */
#ifndef WEFT_REGISTRATION_LAMP_LISTED_H
#define WEFT_REGISTRATION_LAMP_LISTED_H

#include "base/text/light_list.h"
#include "base/text/lines.h"
#include "registration/lamp/photograph.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct weft_listed_lamp {
    bool found, is_position;
    weft_vec3 light;      /* plate frame: unit, or mm */
    double deviation_rad; /* standard error of its direction; of a position that of its distance, too, relative */
} weft_listed_lamp;

/* Errors: WEFT_BAD_INPUT naming the line of a position less than 20 mm from the middle: it is neither a unit vector nor
 * in mm; or where no photograph is listed. */
weft_code weft_listed_check(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                            weft_error *error);

/* The listed lamp of a photograph, by its name and its pose. An .lp file counts x to the right of the picture as it is
 * shown (Exif orientation), y up, z to the camera; a table is in the plate frame. Standard error: as listed, else 1
 * degree. Pure. */
weft_listed_lamp weft_listed_lamp_of(const weft_light_list *list, const weft_photographs_photograph *photograph);

/* Adds a line for each photograph that is used, whose lamp or view lies farther from the list than 2.5 standard errors
 * of both; the notes of the list; one line where the whole list seems to have other axes, or has rows without a
 * photograph. What a list says of the azimuth of views counts from anywhere. Errors: WEFT_SYSTEM for memory. */
weft_code weft_listed_compare(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                              weft_lines *notes, weft_error *error);

#ifdef __cplusplus
}
#endif
#endif
