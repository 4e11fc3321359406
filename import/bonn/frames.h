/* The frames of the texels of a file of Bonn, for the dataset. */
#ifndef WEFT_IMPORT_BONN_FRAMES_H
#define WEFT_IMPORT_BONN_FRAMES_H

#include "import/bonn/file.h"

/* frames [height][width][2][3], unit normal and tangent: the means over the texels of the file whose centres lie in
 * each. False where one of the file is no frame above the surface, or a mean has no direction. Pure. */
bool weft_bonn_frames_average(const weft_bonn_file *file, int width, int height, float *frames);

#endif
