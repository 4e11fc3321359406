#include "base/picture/open_bridge.h"
#include "base/picture/tiff_sensitivity.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstring>
#include <initializer_list>

namespace
{

/* The first of the names that holds a positive number; formats disagree about names. */
double number_of(const OIIO::ImageSpec &spec, std::initializer_list<const char *> names)
{
    for (const char *name : names) {
        const double value = (double)spec.get_float_attribute(name, 0);
        if (value > 0 && std::isfinite(value))
            return value;
        /* What TIFF holds as an int is no float to OpenImageIO 2.4. */
        if (const int whole = spec.get_int_attribute(name, 0); whole > 0)
            return whole;
    }
    return 0;
}

} // namespace

void weft_exif_of(OIIO::ImageInput &input, const char *path, weft_exif *exif)
{
    const OIIO::ImageSpec &spec = input.spec();
    *exif = {};
    /* OpenEXR shows another rectangle than it stores. */
    bool is_exr = strcmp(input.format_name(), "openexr") == 0;
    exif->width = is_exr ? spec.full_width : spec.width;
    exif->height = is_exr ? spec.full_height : spec.height;
    exif->is_float = spec.format.is_floating_point();
    exif->is_linear = exif->is_float || strcmp(input.format_name(), "raw") == 0;
    exif->bits = spec.get_int_attribute("oiio:BitsPerSample", (int)(8 * spec.format.size()));
    exif->orientation = spec.get_int_attribute("Orientation", 1);
    exif->exposure_s = number_of(spec, {"ExposureTime"});
    exif->f_number = number_of(spec, {"FNumber"});
    exif->iso = number_of(
        spec, {"Exif:PhotographicSensitivity", "Exif:ISOSpeedRatings", "Exif:ISOSpeed", "ISOSpeed", "raw:iso_speed"});
    if (exif->iso <= 0 && strcmp(input.format_name(), "tiff") == 0)
        exif->iso = weft_tiff_sensitivity(path);
    exif->focal_length_mm = number_of(spec, {"Exif:FocalLength"});
    exif->focal_length_35mm = number_of(spec, {"Exif:FocalLengthIn35mmFilm"});
}
