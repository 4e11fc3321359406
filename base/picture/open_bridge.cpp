#include "base/picture/open_bridge.h"

#include "base/atomic_file.h"
#include "base/picture/container.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

/* Why a file could not be read: whether it can be opened at all tells what is at fault, the file or the system. */
static weft_code code_of(const char *path)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return weft_code_of_reading(errno);
    close(descriptor);
    return WEFT_DAMAGED;
}

std::string weft_first_line(const std::string &text)
{
    std::string line = text.substr(0, text.find('\n'));
    /* Messages quote what a damaged file holds. */
    std::replace_if(
        line.begin(), line.end(), [](unsigned char letter) { return letter < 0x20 || letter == 0x7f; }, '?');
    return line;
}

weft_code weft_image_unreadable(weft_error *error, const char *path, const std::string &why)
{
    const std::string line = weft_first_line(why);
    return weft_fail(error, code_of(path), "cannot read image '%s': %s", path,
                     line.empty() ? "damaged, or of no known format" : line.c_str());
}

namespace
{

/* Camera raw as the sensor counted: no curve, no white balance, no brightness of each picture's own. The shape of the
 * colour filters is interpolated all the same. */
OIIO::ImageSpec input_hints()
{
    const float even[4] = {1, 1, 1, 1};
    OIIO::ImageSpec hints;
    /* Else what is half transparent comes half as bright. */
    hints["oiio:UnassociatedAlpha"] = 1;
    hints["raw:ColorSpace"] = "raw";
    hints["raw:auto_bright"] = 0;
    hints["raw:use_camera_wb"] = 0;
    hints["raw:use_camera_matrix"] = 0;
    hints["raw:adjust_maximum_thr"] = 0.0f;
    hints.attribute("raw:user_mul", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 4), even);
    return hints;
}

/* The reader of a container; a TIFF reader would show the preview of camera raw, and readers of other formats take
 * their time before they give up. NULL: whichever reader knows the file. */
const char *reader_of(weft_container container)
{
    static const char *const name[] = {nullptr, "png", "tiff", "raw", "openexr", "heif"};
    return name[container];
}

std::unique_ptr<OIIO::ImageInput> open_by(const char *reader, const char *path, std::string *why)
{
    const OIIO::ImageSpec hints = input_hints();
    auto input = reader ? OIIO::ImageInput::create(reader) : OIIO::ImageInput::open(path, &hints);
    OIIO::ImageSpec spec;
    if (reader && input && !input->open(path, spec, hints)) {
        *why = input->geterror();
        return nullptr;
    }
    if (!input)
        *why = OIIO::geterror();
    return input;
}

/* Some cameras and programs pad the data of a JPEG before its end. Where damage made a decoder skip, more is left. */
bool is_padding(const std::string &complaint)
{
    constexpr int most_bytes = 64;
    size_t place = complaint.find("Corrupt JPEG data: ");
    int bytes = 0;
    return place != std::string::npos &&
           sscanf(complaint.c_str() + place, "Corrupt JPEG data: %d extraneous bytes before marker 0xd9", &bytes) ==
               1 &&
           bytes <= most_bytes && complaint.find("0xd9") != std::string::npos;
}

bool is_harmless(const OIIO::ImageInput &input, const std::string &complaint)
{
    if (strcmp(input.format_name(), "jpeg") != 0)
        return complaint.empty();
    bool is_damage = complaint.find("Corrupt JPEG data") != std::string::npos ||
                     complaint.find("Premature end") != std::string::npos;
    return !is_damage || is_padding(complaint);
}

} // namespace

std::unique_ptr<OIIO::ImageInput> weft_image_open(const char *path, weft_colour_tags *tags, weft_code *code,
                                                  weft_error *error)
{
    weft_container container;
    std::string why;
    *code = weft_container_read(path, &container, tags, error);
    if (*code != WEFT_OK)
        return nullptr;
    auto input = open_by(reader_of(container), path, &why);
    *code = input ? WEFT_OK : weft_image_unreadable(error, path, why);
    return input;
}

weft_code weft_image_check_read(OIIO::ImageInput &input, const char *path, weft_error *error)
{
    const std::string complaint = input.geterror();
    if (is_harmless(input, complaint))
        return WEFT_OK;
    return weft_fail(error, WEFT_DAMAGED, "image '%s' is not whole: %s", path, weft_first_line(complaint).c_str());
}
