#include "base/picture/image_library.h"

#include <dlfcn.h>
#include <stdatomic.h>
#include <stddef.h>

static const char module_name[] = "weft_image_library.so";

weft_code weft_image_library_open(const weft_image_library **library, weft_error *error)
{
    static _Atomic(const weft_image_library *) opened;
    *library = atomic_load(&opened);
    if (*library)
        return WEFT_OK;
    /* Threads that come here at once get the same module. */
    void *module = dlopen(module_name, RTLD_NOW | RTLD_LOCAL);
    *library = module ? dlsym(module, "weft_image_library_table") : NULL;
    if (!*library)
        return weft_fail(error, WEFT_SYSTEM, "pictures cannot be read or written: %s", dlerror());
    atomic_store(&opened, *library);
    return WEFT_OK;
}
