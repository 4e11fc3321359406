#include "base/picture/open_bridge.h"

#include "base/atomic_file.h"

#include <cerrno>
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
    return text.substr(0, text.find('\n'));
}

weft_code weft_image_unreadable(weft_error *error, const char *path, const std::string &why)
{
    const std::string line = weft_first_line(why);
    return weft_fail(error, code_of(path), "cannot read image '%s': %s", path,
                     line.empty() ? "damaged, or of no known format" : line.c_str());
}

std::unique_ptr<OIIO::ImageInput> weft_image_open(const char *path, const OIIO::ImageSpec *hints, weft_code *code,
                                                  weft_error *error)
{
    auto input = OIIO::ImageInput::open(path, hints);
    *code = input ? WEFT_OK : weft_image_unreadable(error, path, OIIO::geterror());
    return input;
}
