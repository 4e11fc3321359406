/* How the bridges open the file of an image, and what they say where they cannot. For the bridges alone. */
#ifndef WEFT_BASE_PICTURE_OPEN_BRIDGE_H
#define WEFT_BASE_PICTURE_OPEN_BRIDGE_H

#include "base/picture/colour_tags.h"
#include "base/status.h"

#include <OpenImageIO/imageio.h>
#include <memory>
#include <string>

/* One line of a message of OpenImageIO. */
std::string weft_first_line(const std::string &text);

/* WEFT_BAD_INPUT: `why` is the library's message, of any number of lines. */
weft_code weft_image_unreadable(weft_error *error, const char *path, const std::string &why);

/* Opens the file, whose structure is checked before, by the reader for what it holds; its name decides nothing where it
 * is camera raw. `tags` receives the colours of the container and is the caller's to free, come what may. NULL where it
 * is no image, or not whole: then the error says so, and *code. */
std::unique_ptr<OIIO::ImageInput> weft_image_open(const char *path, weft_colour_tags *tags, weft_code *code,
                                                  weft_error *error);

/* WEFT_DAMAGED where the library read a picture and complains of its data, as of a JPEG that ends too early. */
weft_code weft_image_check_read(OIIO::ImageInput &input, const char *path, weft_error *error);

/* WEFT_DAMAGED where camera raw cannot be unpacked, or only with errors, which OpenImageIO does not tell. */
weft_code weft_raw_check_packing(const char *path, weft_error *error);

/* WEFT_DAMAGED where camera raw has rows without any light, or nothing but one value: no sensor counts so. */
weft_code weft_raw_check_light(const weft_image *image, const char *path, weft_error *error);

/* ---- Exr bridge ---- */

/* What of an EXR file is the picture. Only EXR names its channels as it likes, and stores another rectangle than it
 * shows. For the bridge alone. */

/* The first of three channels that are red, green and blue: those of no layer, else those of the only layer. Errors:
 * WEFT_BAD_INPUT, naming the channels, where there are none, or more than one layer of them. */
weft_code weft_exr_colour_channels(const OIIO::ImageSpec &spec, const char *path, int *first, weft_error *error);

/* The only channel of one or two that is neither alpha nor depth. Errors: as above. */
weft_code weft_exr_grey_channel(const OIIO::ImageSpec &spec, const char *path, int *channel, weft_error *error);

/* Turns the pixels that are stored (the data window) into those that are shown (the display window): what lies outside
 * is cut off, what is not stored is NaN, and the image partial. Errors: WEFT_DAMAGED where nothing is stored of what is
 * shown; WEFT_SYSTEM for memory; then the picture is as it was. */
weft_code weft_exr_show_window(const OIIO::ImageSpec &spec, const char *path, weft_image *image, weft_error *error);

/* ---- What is said beside the pixels ---- */

/* The numbers of Exif. */
void weft_exif_of(OIIO::ImageInput &input, const char *path, weft_exif *exif);

/* Adds to the tags of the container. The picture after the first is the current one then. Errors: WEFT_SYSTEM. */
weft_code weft_colour_tags_of(OIIO::ImageInput &input, const char *path, weft_colour_tags *tags, weft_error *error);

#endif
