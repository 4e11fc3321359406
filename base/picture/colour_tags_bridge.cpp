#include "base/picture/open_bridge.h"

#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace
{

weft_code copy_profile(const OIIO::ImageSpec &spec, const char *path, weft_colour_tags *tags, weft_error *error)
{
    const OIIO::ParamValue *found = spec.find_attribute("ICCProfile");
    if (tags->profile || !found || found->type().basetype != OIIO::TypeDesc::UINT8 || found->type().size() == 0)
        return WEFT_OK;
    tags->profile_size = found->type().size();
    tags->profile = static_cast<uint8_t *>(malloc(tags->profile_size));
    if (!tags->profile)
        return weft_fail_memory(error, path, tags->profile_size);
    memcpy(tags->profile, found->data(), tags->profile_size);
    return WEFT_OK;
}

void copy_primaries(const OIIO::ImageSpec &spec, weft_colour_tags *tags)
{
    const OIIO::ParamValue *found = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    tags->has_primaries = tags->has_primaries || found;
    for (int i = 0; found && i < 8; i++)
        tags->primaries[i] = double(found->get_float_indexed(i));
}

/* OpenImageIO makes RGB of inks by a rule of thumb, and leaves L*a*b* as it is. */
void copy_model(const OIIO::ImageSpec &spec, weft_colour_tags *tags)
{
    for (const char *name : {"jpeg:ColorSpace", "tiff:ColorSpace"}) {
        const std::string model = spec.get_string_attribute(name);
        if (model == "CMYK" || model == "YCbCrK" || model == "CIELAB" || model == "ICCLAB" || model == "ITULAB")
            snprintf(tags->model, sizeof tags->model, "%s", model == "YCbCrK" ? "CMYK" : model.c_str());
    }
}

} // namespace

weft_code weft_colour_tags_of(OIIO::ImageInput &input, const char *path, weft_colour_tags *tags, weft_error *error)
{
    constexpr int uncalibrated = 65535;
    const OIIO::ImageSpec &spec = input.spec();
    tags->is_float = spec.format.is_floating_point();
    tags->is_raw = strcmp(input.format_name(), "raw") == 0;
    tags->is_grey = spec.nchannels < 3;
    tags->is_uncalibrated = spec.get_int_attribute("Exif:ColorSpace", 0) == uncalibrated;
    tags->bits = int(8 * spec.format.size());
    copy_primaries(spec, tags);
    copy_model(spec, tags);
    WEFT_TRY(copy_profile(spec, path, tags, error));
    tags->has_more = input.seek_subimage(1, 0); /* the head is that of the second then */
    return WEFT_OK;
}
