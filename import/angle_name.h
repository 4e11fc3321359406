/* Names of photographs that tell the angles of light and view. */
#ifndef WEFT_IMPORT_ANGLE_NAME_H
#define WEFT_IMPORT_ANGLE_NAME_H

#include "btf/direction/direction.h"

#include <stdbool.h>

typedef struct weft_named_angles {
    weft_angles light, view;
} weft_named_angles;

/* Reads tl, pl, tv and pv (degrees, decimals allowed, any case and order) from the name of a file: words separated by
 * blanks, _ or -. Folders in front and the extension are ignored. False where one of the four is missing, or occurs
 * twice. Pure. */
bool weft_angle_name_parse(const char *name, weft_named_angles *angles);

/* Why the angles in a name may be misread, in words for the user; NULL where they are clear. Four digits without a
 * point may be tenths of degrees, and digits that stand alone behind an angle may be its decimals. Pure. */
const char *weft_angle_name_doubt(const char *name);

/* The UTIA name "tlTTT_plPPP_tvTTT_pvPPP" of four angles. Pure. */
void weft_angle_name_write(const weft_named_angles *angles, char name[64]);

#endif
