/* How far from the plane of the texels heights are looked for, as the cloth itself tells. Private to the room. */
#ifndef WEFT_RELIEF_REACH_H
#define WEFT_RELIEF_REACH_H

#include "relief/features.h"

/* The least distance, mm, after which the cloth repeats along one of its axes, from the autocorrelation of the view
 * that looks down most steeply (base/numeric/repeat.h). Infinity where it repeats along neither. Errors: WEFT_SYSTEM.
 */
weft_code weft_relief_period(const weft_features *features, double *period_mm, weft_error *error);

/* Heights lie within reach_mm above and below the plane of the texels. A stitch is hardly taller than it is wide, so
 * 1.25 times its width is enough: the period of the cloth, or all of it where it is one tile. Further off, threads
 * agree with their neighbours by chance. Where nothing repeats, the reach is a quarter of the shorter side, but no more
 * than 24 texels: parallax is told as far as that. Errors: WEFT_SYSTEM. */
weft_code weft_relief_reach(const weft_features *features, double *reach_mm, weft_error *error);

#endif
