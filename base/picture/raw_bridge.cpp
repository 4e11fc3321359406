#include "base/picture/open_bridge.h"

#include <algorithm>
#include <dlfcn.h>

namespace
{

/* The C interface of LibRaw, which OpenImageIO has loaded; it neither installs its headers nor tells what LibRaw says.
 */
struct raw_library {
    void *(*init)(unsigned flags);
    void (*set_dataerror_handler)(void *raw, void (*handler)(void *context, const char *file, long offset),
                                  void *context);
    int (*open_file)(void *raw, const char *path);
    int (*unpack)(void *raw);
    void (*close)(void *raw);
};

template <typename Function> bool find(const char *name, Function *function)
{
    *function = reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, name));
    return *function != nullptr;
}

void count_damage(void *context, const char *, long)
{
    ++*static_cast<int *>(context);
}

/* Places of a file where what is packed is no number of a sensor; 0 where LibRaw cannot be asked. */
int count_damaged_places(const char *path)
{
    raw_library library;
    int count = 0;
    if (!find("libraw_init", &library.init) || !find("libraw_set_dataerror_handler", &library.set_dataerror_handler) ||
        !find("libraw_open_file", &library.open_file) || !find("libraw_unpack", &library.unpack) ||
        !find("libraw_close", &library.close))
        return 0;
    void *raw = library.init(0);
    if (!raw)
        return 0;
    library.set_dataerror_handler(raw, count_damage, &count);
    if (library.open_file(raw, path) == 0 && library.unpack(raw) != 0)
        count++;
    library.close(raw);
    return count;
}

bool is_all(const float *sample, size_t count, float value)
{
    return std::all_of(sample, sample + count, [value](float s) { return s == value; });
}

} // namespace

weft_code weft_raw_check_packing(const char *path, weft_error *error)
{
    return count_damaged_places(path) == 0
               ? WEFT_OK
               : weft_fail(error, WEFT_DAMAGED, "image '%s' is not whole: the values of its sensor are damaged", path);
}

weft_code weft_raw_check_light(const weft_image *image, const char *path, weft_error *error)
{
    const size_t row_samples = 3 * size_t(image->width);
    int dark = 0, alike = 0;
    for (int y = 0; y < image->height; y++) {
        const float *row = image->pixels + row_samples * size_t(y);
        dark += is_all(row, row_samples, 0);
        alike += is_all(row, row_samples, image->pixels[0]);
    }
    if (dark > 8 + image->height / 64)
        return weft_fail(error, WEFT_DAMAGED, "image '%s' is not whole: %d of its %d rows hold nothing", path, dark,
                         image->height);
    if (alike > image->height * 9LL / 10)
        return weft_fail(error, WEFT_DAMAGED, "image '%s' has the same value everywhere: no photograph is like that",
                         path);
    return WEFT_OK;
}
