/* What of an EXR file is the picture. Only EXR names its channels as it likes, and stores another rectangle than it
 * shows. For the bridge alone. */
#ifndef WEFT_BASE_PICTURE_EXR_BRIDGE_H
#define WEFT_BASE_PICTURE_EXR_BRIDGE_H

#include "base/picture/image.h"

#include <OpenImageIO/imageio.h>

/* The first of three channels that are red, green and blue: those of no layer, else those of the only layer. Errors:
 * WEFT_BAD_INPUT, naming the channels, where there are none, or more than one layer of them. */
weft_code weft_exr_colour_channels(const OIIO::ImageSpec &spec, const char *path, int *first, weft_error *error);

/* Turns the pixels that are stored (the data window) into those that are shown (the display window): what lies outside
 * is cut off, what is not stored is black. Errors: WEFT_SYSTEM for memory; then the picture is as it was. */
weft_code weft_exr_show_window(const OIIO::ImageSpec &spec, weft_image *image, weft_error *error);

#endif
