/* How the bridges open the file of an image, and what they say where they cannot. For the bridges alone. */
#ifndef WEFT_BASE_PICTURE_OPEN_BRIDGE_H
#define WEFT_BASE_PICTURE_OPEN_BRIDGE_H

#include "base/status.h"

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

/* One line of a message of OpenImageIO. */
std::string weft_first_line(const std::string &text);

/* WEFT_BAD_INPUT: `why` is the library's message, of any number of lines. */
weft_code weft_image_unreadable(weft_error *error, const char *path, const std::string &why);

/* Opens the file; `hints` may be NULL. NULL where it is no image: then the error says so, and *code. */
std::unique_ptr<OIIO::ImageInput> weft_image_open(const char *path, const OIIO::ImageSpec *hints, weft_code *code,
                                                  weft_error *error);

#endif
