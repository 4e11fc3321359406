#include "compress/run/memory.h"

#include <inttypes.h>
#include <limits.h>
#include <malloc.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static uint64_t smaller(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* The number in a file; none where there is no file or it says "max". */
static uint64_t read_limit(const char *path)
{
    uint64_t limit;
    FILE *file = fopen(path, "re");
    if (!file)
        return UINT64_MAX;
    if (fscanf(file, "%" SCNu64, &limit) != 1)
        limit = UINT64_MAX;
    fclose(file);
    return limit;
}

/* The least limit of a control group and of those that hold it. `group` begins with a slash and is cut. */
static uint64_t least_limit(const char *root, char *group, const char *name)
{
    uint64_t least = UINT64_MAX;
    for (;;) {
        char path[2 * PATH_MAX];
        snprintf(path, sizeof path, "%s%s/%s", root, group, name);
        least = smaller(least, read_limit(path));
        char *slash = strrchr(group, '/');
        if (!slash)
            return least;
        *slash = '\0';
    }
}

/* /proc/self/cgroup has lines "0::GROUP" (v2) and "N:CONTROLLERS:GROUP" (v1). */
static uint64_t group_limit(void)
{
    uint64_t least = UINT64_MAX;
    char line[PATH_MAX];
    FILE *file = fopen("/proc/self/cgroup", "re");
    if (!file)
        return least;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        char *controllers = strchr(line, ':'), *group = controllers ? strchr(controllers + 1, ':') : NULL;
        if (!group)
            continue;
        *group++ = '\0';
        if (strcmp(controllers, ":") == 0)
            least = smaller(least, least_limit("/sys/fs/cgroup", group, "memory.max"));
        else if (strstr(controllers, "memory"))
            least = smaller(least, least_limit("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes"));
    }
    fclose(file);
    return least;
}

uint64_t weft_memory_default(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
    uint64_t physical = pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes : UINT64_MAX;
    return smaller(physical, group_limit()) / 4;
}

uint64_t weft_memory_resident(void)
{
    uint64_t size, resident = 0;
    FILE *file = fopen("/proc/self/statm", "re");
    if (!file)
        return 0;
    if (fscanf(file, "%" SCNu64 " %" SCNu64, &size, &resident) != 2)
        resident = 0;
    fclose(file);
    return resident * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* Bytes that malloc has handed out and not got back, touched or not. */
static uint64_t allocated_bytes(void)
{
    struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

weft_memory_budget weft_memory_budget_begin(uint64_t limit)
{
    uint64_t resident = weft_memory_resident(), allocated = allocated_bytes();
    return (weft_memory_budget){.limit = limit > 0 ? limit : weft_memory_default(),
                                .overhead = resident > allocated ? resident - allocated : 0};
}

uint64_t weft_memory_budget_taken(const weft_memory_budget *budget)
{
    return budget->overhead + allocated_bytes();
}

weft_code weft_memory_budget_require(const weft_memory_budget *budget, uint64_t bytes, const char *path,
                                     const char *what, weft_error *error)
{
    uint64_t needed = weft_memory_budget_taken(budget) + bytes;
    if (needed <= budget->limit)
        return WEFT_OK;
    return weft_fail(error, WEFT_BAD_USAGE,
                     "'%s' needs %" PRIu64 " MB of memory for %s, more than the limit of %" PRIu64 " MB", path,
                     needed / 1000000 + 1, what, budget->limit / 1000000);
}
