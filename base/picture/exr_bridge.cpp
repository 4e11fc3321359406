#include "base/picture/open_bridge.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

namespace
{

bool is_named(const std::string &channel, const char *name)
{
    return strcasecmp(channel.c_str(), name) == 0;
}

bool is_colour(const OIIO::ImageSpec &spec, int first)
{
    static const char *const letters[] = {"R", "G", "B"}, *const words[] = {"red", "green", "blue"};
    bool found = first + 3 <= spec.nchannels;
    for (int c = 0; found && c < 3; c++) {
        const std::string &name = spec.channelnames[size_t(first + c)];
        const std::string letter = name.substr(name.rfind('.') + 1);
        found = is_named(letter, letters[c]) || is_named(letter, words[c]);
    }
    return found;
}

/* "diffuse.R" is of the layer "diffuse", "R" of none. */
std::string layer_of(const std::string &channel)
{
    size_t dot = channel.rfind('.');
    return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

/* The first of three channels that are red, green and blue, or -1: those of no layer, else those of the only layer. */
int first_of_colour(const OIIO::ImageSpec &spec)
{
    int found = -1, count = 0;
    for (int c = 0; c < spec.nchannels; c++) {
        if (!is_colour(spec, c))
            continue;
        if (layer_of(spec.channelnames[size_t(c)]).empty())
            return c;
        found = c;
        count++;
    }
    return count == 1 ? found : -1;
}

std::string names_of(const OIIO::ImageSpec &spec)
{
    std::string names;
    for (const std::string &name : spec.channelnames)
        names += (names.empty() ? "" : ", ") + name;
    return names;
}

} // namespace

weft_code weft_exr_colour_channels(const OIIO::ImageSpec &spec, const char *path, int *first, weft_error *error)
{
    *first = first_of_colour(spec);
    return *first >= 0 ? WEFT_OK
                       : weft_fail(error, WEFT_BAD_INPUT,
                                   "image '%s' has no channels R, G, B, or more than one layer of them: %s", path,
                                   names_of(spec).c_str());
}

weft_code weft_exr_grey_channel(const OIIO::ImageSpec &spec, const char *path, int *channel, weft_error *error)
{
    static const char *const others[] = {"A", "alpha", "Z", "ZBack", "depth"};
    int count = 0;
    for (int c = spec.nchannels - 1; c >= 0; c--) {
        const std::string &name = spec.channelnames[size_t(c)];
        const std::string letter = name.substr(name.rfind('.') + 1);
        if (std::any_of(std::begin(others), std::end(others), [&](const char *o) { return is_named(letter, o); }))
            continue;
        *channel = c;
        count++;
    }
    return count == 1 ? WEFT_OK
                      : weft_fail(error, WEFT_BAD_INPUT, "image '%s' has no channels R, G, B, nor a grey one: %s", path,
                                  names_of(spec).c_str());
}

weft_code weft_exr_show_window(const OIIO::ImageSpec &spec, const char *path, weft_image *image, weft_error *error)
{
    /* Both lie anywhere within 31 bits. */
    long long left = (long long)spec.x - spec.full_x, top = (long long)spec.y - spec.full_y;
    if (left == 0 && top == 0 && spec.full_width == spec.width && spec.full_height == spec.height)
        return WEFT_OK;
    long long begin = std::max(0ll, left), end = std::min<long long>(spec.full_width, left + spec.width);
    long long first = std::max(0ll, top), last = std::min<long long>(spec.full_height, top + spec.height);
    if (begin >= end || first >= last)
        return weft_fail(error, WEFT_DAMAGED, "image '%s' holds no pixel of what it shows: its windows do not overlap",
                         path);
    weft_image shown;
    WEFT_TRY(weft_image_create(spec.full_width, spec.full_height, &shown, error));
    shown.is_partial = begin > 0 || end < spec.full_width || first > 0 || last < spec.full_height;
    std::fill_n(shown.pixels, 3 * size_t(shown.width) * size_t(shown.height), std::numeric_limits<float>::quiet_NaN());
    for (long long y = first; y < last; y++)
        memcpy(shown.pixels + 3 * (size_t(y) * size_t(shown.width) + size_t(begin)),
               image->pixels + 3 * (size_t(y - top) * size_t(image->width) + size_t(begin - left)),
               3 * size_t(end - begin) * sizeof(float));
    weft_image_free(image);
    *image = shown;
    return WEFT_OK;
}
