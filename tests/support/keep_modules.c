#include "keep_modules.h"

#include <dlfcn.h>
#include <link.h>

enum { MAX_MODULES = 512 };

typedef struct module_list {
    int count;
    const char *path[MAX_MODULES];
} module_list;

static int note_module(struct dl_phdr_info *info, size_t size, void *context)
{
    (void)size;
    module_list *list = context;
    if (info->dlpi_name[0] == '/' && list->count < MAX_MODULES)
        list->path[list->count++] = info->dlpi_name;
    return 0;
}

void keep_modules_loaded(void)
{
    module_list list = {0};
    dl_iterate_phdr(note_module, &list);
    for (int i = 0; i < list.count; i++)
        dlopen(list.path[i], RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
}
