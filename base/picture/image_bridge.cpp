#include "base/atomic_file.h"
#include "base/picture/image_library.h"
#include "base/picture/open_bridge.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace
{

constexpr long long max_pixels = 1ll << 28;
constexpr const char *settings_name = "weft:settings";
constexpr const char *no_time = "0000:00:00 00:00:00";

/* The tags of a container while a file is open. */
class own_tags
{
  public:
    weft_colour_tags tags = {};
    own_tags() = default;
    own_tags(const own_tags &) = delete;
    own_tags &operator=(const own_tags &) = delete;
    ~own_tags()
    {
        free(tags.profile);
    }
};

std::unique_ptr<OIIO::ImageInput> open_input(const char *path, weft_code *code, weft_error *error)
{
    own_tags own;
    return weft_image_open(path, &own.tags, code, error);
}

bool is_raw(const OIIO::ImageInput &input)
{
    return strcmp(input.format_name(), "raw") == 0;
}

bool is_exr(const OIIO::ImageInput &input)
{
    return strcmp(input.format_name(), "openexr") == 0;
}

/* OpenImageIO turns white that is 0 into black for 8 bits alone. */
void turn_white_to_one(const OIIO::ImageSpec &spec, weft_image *image)
{
    constexpr int white_is_zero = 0;
    size_t count = 3 * size_t(image->width) * size_t(image->height);
    if (spec.get_int_attribute("tiff:PhotometricInterpretation", -1) != white_is_zero ||
        spec.format == OIIO::TypeDesc::UINT8)
        return;
    for (size_t i = 0; i < count; i++)
        image->pixels[i] = 1 - image->pixels[i];
}

/* What follows the reading of samples: how formats mean them, and whether they are all there. */
weft_code finish_floats(OIIO::ImageInput &input, const char *path, weft_image *image, weft_error *error)
{
    WEFT_TRY(weft_image_check_read(input, path, error));
    turn_white_to_one(input.spec(), image);
    if (is_raw(input))
        WEFT_TRY(weft_raw_check_light(image, path, error));
    return is_exr(input) ? weft_exr_show_window(input.spec(), path, image, error) : WEFT_OK;
}

weft_code read_floats(OIIO::ImageInput &input, const char *path, weft_image *image, weft_error *error)
{
    const OIIO::ImageSpec &spec = input.spec();
    int first = 0, channels = spec.nchannels < 3 ? 1 : 3;
    if (is_exr(input))
        WEFT_TRY((channels == 3 ? weft_exr_colour_channels : weft_exr_grey_channel)(spec, path, &first, error));
    if (is_raw(input))
        WEFT_TRY(weft_raw_check_packing(path, error));
    size_t pixel_count = size_t(spec.width) * size_t(spec.height);
    WEFT_TRY(weft_image_create(spec.width, spec.height, image, error));
    weft_code code = WEFT_OK;
    input.geterror();
    if (!input.read_image(0, 0, first, first + channels, OIIO::TypeDesc::FLOAT, image->pixels, 3 * sizeof(float)))
        code = weft_image_unreadable(error, path, input.geterror());
    for (size_t i = 0; code == WEFT_OK && channels == 1 && i < pixel_count; i++)
        image->pixels[3 * i + 1] = image->pixels[3 * i + 2] = image->pixels[3 * i];
    if (code == WEFT_OK)
        code = finish_floats(input, path, image, error);
    if (code != WEFT_OK)
        weft_image_free(image);
    return code;
}

bool is_usable(int width, int height)
{
    return width >= 1 && height >= 1 && (long long)width * height <= max_pixels;
}

/* A header may claim what its file cannot hold: no format packs a photograph so tightly, and none a sensor's noise. */
weft_code check_size(const OIIO::ImageInput &input, const char *path, weft_error *error)
{
    constexpr double few = 1 << 20, most_in_byte = 4096, most_of_sensor_in_byte = 32;
    const OIIO::ImageSpec &spec = input.spec();
    if (is_exr(input) && !is_usable(spec.full_width, spec.full_height))
        return weft_fail(error, WEFT_BAD_INPUT, "image '%s' has an unusable display window: %d x %d", path,
                         spec.full_width, spec.full_height);
    if (!is_usable(spec.width, spec.height) || spec.nchannels < 1 || spec.depth > 1 ||
        (spec.tile_width > 0 && !is_usable(spec.tile_width, spec.tile_height)))
        return weft_fail(error, WEFT_BAD_INPUT, "image '%s' has an unusable size: %d x %d x %d, %d channels", path,
                         spec.width, spec.height, spec.depth, spec.nchannels);
    double pixels = double(spec.width) * double(spec.height), bytes = double(weft_file_bytes(path));
    if (pixels > bytes * (is_raw(input) ? most_of_sensor_in_byte : most_in_byte) && (is_raw(input) || pixels > few))
        return weft_fail(error, WEFT_DAMAGED, "image '%s' is not whole: %.0f bytes cannot hold %d x %d pixels", path,
                         bytes, spec.width, spec.height);
    return WEFT_OK;
}

/* A decoder of HEIF hands over the picture as it is shown. Where a lens is looked for, the pixels must lie as the
 * sensor read them, and the orientation says the rest, as of a JPEG. */
weft_code turn_back(int turned_as, weft_image *image, weft_exif *exif, weft_error *error)
{
    constexpr int clockwise = 6, counterclockwise = 8, exchanged = 5;
    if (turned_as == 0)
        return WEFT_OK;
    if (exif) {
        exif->orientation = turned_as;
        if (turned_as >= exchanged)
            std::swap(exif->width, exif->height);
    }
    int back = turned_as == clockwise ? counterclockwise : turned_as == counterclockwise ? clockwise : turned_as;
    return image ? weft_image_turn(image, back, error) : WEFT_OK;
}

weft_code read_picture(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                       weft_colour_tags *tags, weft_error *error)
{
    weft_code code;
    own_tags own;
    weft_colour_tags *told = tags ? tags : &own.tags;
    auto input = weft_image_open(path, told, &code, error);
    WEFT_TRY(code);
    WEFT_TRY(check_size(*input, path, error));
    if (kind)
        *kind = input->spec().format.is_floating_point() || is_raw(*input) ? WEFT_IMAGE_FLOAT : WEFT_IMAGE_INTEGER;
    if (exif)
        weft_exif_of(*input, path, exif);
    if (image)
        WEFT_TRY(read_floats(*input, path, image, error));
    code = turn_back(told->turned_as, image, exif, error);
    if (code == WEFT_OK && tags)
        code = weft_colour_tags_of(*input, path, tags, error);
    if (code != WEFT_OK && image)
        weft_image_free(image);
    return code;
}

weft_code read_settings(const char *path, char **settings, weft_error *error)
{
    weft_code code;
    auto input = open_input(path, &code, error);
    WEFT_TRY(code);
    *settings = nullptr;
    const OIIO::ParamValue *found = input->spec().find_attribute(settings_name, OIIO::TypeDesc::STRING);
    if (!found)
        return WEFT_OK;
    *settings = strdup(found->get_ustring().c_str());
    return *settings ? WEFT_OK : weft_fail_memory(error, path, found->get_ustring().size());
}

bool has_extension(const std::string &path, const char *extension)
{
    size_t length = strlen(extension);
    return path.size() >= length && strcasecmp(path.c_str() + path.size() - length, extension) == 0;
}

OIIO::TypeDesc type_for(const std::string &path)
{
    if (has_extension(path, ".exr"))
        return OIIO::TypeDesc::HALF;
    if (has_extension(path, ".tif") || has_extension(path, ".tiff"))
        return OIIO::TypeDesc::FLOAT;
    return OIIO::TypeDesc::UINT8;
}

using encoded_bytes = std::vector<unsigned char>;

/* Encodes into memory, because the library keeps silent where a disk is full. */
weft_code encode(const char *path, const OIIO::ImageSpec &spec, const OIIO::TypeDesc &type, const void *pixels,
                 encoded_bytes *bytes, weft_error *error)
{
    OIIO::Filesystem::IOVecOutput memory;
    auto output = OIIO::ImageOutput::create(path);
    if (!output || !output->supports("ioproxy") || !output->set_ioproxy(&memory))
        return weft_fail(error, WEFT_BAD_USAGE, "cannot write image '%s': use .png, .exr or .tif", path);
    if (!output->open(path, spec) || !output->write_image(type, pixels) || !output->close())
        return weft_fail(error, WEFT_SYSTEM, "cannot write image '%s': %s", path,
                         weft_first_line(output->geterror()).c_str());
    *bytes = memory.buffer();
    return WEFT_OK;
}

weft_code write_image(const char *path, const weft_image *image, const char *description, const char *settings,
                      weft_error *error)
{
    OIIO::TypeDesc type = type_for(path);
    OIIO::ImageSpec spec(image->width, image->height, 3, type);
    spec.attribute("oiio:ColorSpace", type == OIIO::TypeDesc::UINT8 ? "sRGB" : "linear");
    if (description)
        spec.attribute("ImageDescription", description);
    /* Else EXR and TIFF carry the time of day, and the same picture never has the same bytes twice. */
    spec.attribute("DateTime", no_time);
    if (settings)
        spec.attribute(settings_name, settings);
    encoded_bytes bytes;
    WEFT_TRY(encode(path, spec, OIIO::TypeDesc::FLOAT, image->pixels, &bytes, error));
    return weft_write_file(path, bytes.data(), bytes.size(), error);
}

weft_code write_photograph(const char *path, int width, int height, int bits, const uint16_t *samples,
                           weft_error *error)
{
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:BitsPerSample", bits);
    spec.attribute("oiio:ColorSpace", "linear");
    spec.attribute("compression", "none");
    spec.attribute("tiff:RowsPerStrip", height);
    spec.attribute("DateTime", no_time);
    /* OpenImageIO packs the high bits of 16-bit samples. */
    std::vector<uint16_t> shifted(size_t(width) * size_t(height) * 3);
    for (size_t i = 0; i < shifted.size(); i++)
        shifted[i] = uint16_t(samples[i] << (16 - bits) | samples[i] >> (2 * bits - 16));
    encoded_bytes bytes;
    WEFT_TRY(encode(path, spec, OIIO::TypeDesc::UINT16, shifted.data(), &bytes, error));
    return weft_write_new_file(path, bytes.data(), bytes.size(), error);
}

weft_code read_photograph(const char *path, int width, int height, int bits, uint16_t *samples, weft_error *error)
{
    weft_code code;
    auto input = open_input(path, &code, error);
    WEFT_TRY(code);
    const OIIO::ImageSpec &spec = input->spec();
    if (spec.width != width || spec.height != height || spec.nchannels != 3)
        return weft_fail(error, WEFT_BAD_INPUT, "photograph '%s' is %d x %d with %d channels, not %d x %d with 3", path,
                         spec.width, spec.height, spec.nchannels, width, height);
    /* Depths that TIFF does not pack are stored in 16 bits. */
    int stored_bits = spec.get_int_attribute("oiio:BitsPerSample", int(8 * spec.format.basesize()));
    if (stored_bits != bits && stored_bits != 16)
        return weft_fail(error, WEFT_BAD_INPUT, "photograph '%s' has %d bits a sample, not %d", path, stored_bits,
                         bits);
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT16, samples))
        return weft_image_unreadable(error, path, input->geterror());
    WEFT_TRY(weft_image_check_read(*input, path, error));
    size_t count = size_t(width) * size_t(height) * 3;
    for (size_t i = 0; i < count; i++)
        samples[i] = uint16_t(samples[i] >> (16 - bits));
    return WEFT_OK;
}

OIIO::TypeDesc snapshot_type(const std::string &path)
{
    if (has_extension(path, ".exr"))
        return OIIO::TypeDesc::HALF;
    return has_extension(path, ".jpg") ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::UINT16;
}

void note(OIIO::ImageSpec *spec, const weft_camera_notes *notes)
{
    spec->attribute("Make", notes->make);
    spec->attribute("Model", notes->model);
    spec->attribute("DateTime", notes->date);
    spec->attribute("Exif:DateTimeOriginal", notes->date);
    spec->attribute("Orientation", notes->orientation);
    /* One over a whole number, which OpenImageIO 2.4 turns into one over nothing. */
    spec->attribute("ExposureTime", std::nextafter(float(notes->exposure_s), 0.0f));
    spec->attribute("FNumber", float(notes->f_number));
    /* TIFF takes but the latter. */
    spec->attribute("Exif:PhotographicSensitivity", int(notes->iso + 0.5));
    spec->attribute("Exif:ISOSpeed", int(notes->iso + 0.5));
    spec->attribute("Exif:FocalLength", float(notes->focal_length_mm));
    spec->attribute("Exif:FocalLengthIn35mmFilm", int(notes->focal_length_35mm + 0.5));
}

weft_code write_to(const char *path, const OIIO::ImageSpec &spec, const weft_image *image, weft_error *error)
{
    auto output = OIIO::ImageOutput::create(path);
    if (!output || !output->open(path, spec) || !output->write_image(OIIO::TypeDesc::FLOAT, image->pixels) ||
        !output->close())
        return weft_fail(error, WEFT_SYSTEM, "cannot write image '%s': %s", path,
                         weft_first_line(output ? output->geterror() : OIIO::geterror()).c_str());
    /* The library keeps silent where a disk is full. */
    if (weft_file_bytes(path) < spec.image_bytes(true))
        return weft_fail(error, WEFT_SYSTEM, "cannot write image '%s': it was cut short", path);
    return WEFT_OK;
}

/* OpenImageIO 2.4 spoils the Exif of a TIFF that it writes into memory. */
weft_code write_tiff_snapshot(const char *path, OIIO::ImageSpec *spec, const weft_image *image, weft_error *error)
{
    weft_atomic_file file;
    spec->attribute("compression", "none");
    WEFT_TRY(weft_atomic_file_begin(path, &file, error));
    weft_code code = write_to(file.temporary_path, *spec, image, error);
    if (code == WEFT_OK)
        return weft_atomic_file_commit(&file, error);
    weft_atomic_file_abandon(&file);
    return code;
}

weft_code write_snapshot(const char *path, const weft_image *image, const weft_camera_notes *notes, weft_error *error)
{
    OIIO::TypeDesc type = snapshot_type(path);
    OIIO::ImageSpec spec(image->width, image->height, 3, type);
    bool is_jpeg = type == OIIO::TypeDesc::UINT8;
    spec.attribute("oiio:ColorSpace", is_jpeg ? "sRGB" : "linear");
    if (is_jpeg)
        spec.attribute("compression", "jpeg:93");
    note(&spec, notes);
    if (type == OIIO::TypeDesc::UINT16)
        return write_tiff_snapshot(path, &spec, image, error);
    encoded_bytes bytes;
    WEFT_TRY(encode(path, spec, OIIO::TypeDesc::FLOAT, image->pixels, &bytes, error));
    return weft_write_file(path, bytes.data(), bytes.size(), error);
}

/* No C++ exception leaves the bridge. */
template <typename Action> weft_code guarded(const char *path, weft_error *error, Action action)
{
    try {
        return action();
    } catch (const std::bad_alloc &) {
        return weft_fail_memory(error, path, 0);
    } catch (const std::exception &exception) {
        return weft_fail(error, WEFT_BAD_INPUT, "image '%s': %s", path, weft_first_line(exception.what()).c_str());
    }
}

weft_code picture_read(const char *path, weft_image *image, weft_image_kind *kind, weft_exif *exif,
                       weft_colour_tags *tags, weft_error *error)
{
    return guarded(path, error, [&] { return read_picture(path, image, kind, exif, tags, error); });
}

weft_code image_write(const char *path, const weft_image *image, const char *description, const char *settings,
                      weft_error *error)
{
    return guarded(path, error, [&] { return write_image(path, image, description, settings, error); });
}

weft_code image_read_settings(const char *path, char **settings, weft_error *error)
{
    return guarded(path, error, [&] { return read_settings(path, settings, error); });
}

weft_code photograph_write(const char *path, int width, int height, int bits, const uint16_t *samples,
                           weft_error *error)
{
    return guarded(path, error, [&] { return write_photograph(path, width, height, bits, samples, error); });
}

weft_code photograph_read(const char *path, int width, int height, int bits, uint16_t *samples, weft_error *error)
{
    return guarded(path, error, [&] { return read_photograph(path, width, height, bits, samples, error); });
}

weft_code snapshot_write(const char *path, const weft_image *image, const weft_camera_notes *notes, weft_error *error)
{
    return guarded(path, error, [&] { return write_snapshot(path, image, notes, error); });
}

} // namespace

extern "C" const weft_image_library weft_image_library_table = {
    picture_read, image_write, image_read_settings, photograph_write, photograph_read, snapshot_write,
};
