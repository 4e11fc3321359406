/* Mutates a valid file deterministically: fuzz_NAME ITERATIONS. A crash or a sanitizer report is the failure. */
#include "tests/support/fuzz.h"

#include "tests/support/scratch_folder.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

const char *fuzz_file(const uint8_t *bytes, size_t size)
{
    static char path[64];
    static int descriptor = -1;
    if (descriptor < 0)
        descriptor = memfd_create("fuzz", 0);
    if (descriptor < 0 || ftruncate(descriptor, 0) != 0 || pwrite(descriptor, bytes, size, 0) != (ssize_t)size)
        abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    return path;
}

static uint64_t random_state = 1;

/* xorshift64* (Vigna 2016). */
static size_t random_below(size_t limit)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (size_t)((random_state * 0x2545f4914f6cdd1dull) >> 16) % limit;
}

static void mutate_once(uint8_t *bytes, size_t *size)
{
    static const uint8_t extreme[6] = {0, 1, 0x7f, 0x80, 0xfe, 0xff};
    /* Half of the changes go where the structure is. */
    size_t reach = random_below(2) && *size > 1024 ? 1024 : *size;
    size_t at = random_below(reach), run = 1 + random_below(8);
    run = run > *size - at ? *size - at : run;
    switch (random_below(5)) {
    case 0:
        bytes[at] ^= (uint8_t)(1 << random_below(8));
        break;
    case 1:
        memset(bytes + at, extreme[random_below(6)], run);
        break;
    case 2:
        memmove(bytes + at, bytes + random_below(*size - run + 1), run);
        break;
    case 3:
        *size = random_below(20) == 0 ? at + 1 : *size;
        break;
    default:
        bytes[at] = (uint8_t)random_below(256);
    }
}

int main(int argc, char **argv)
{
    int iterations = argc > 1 ? atoi(argv[1]) : 1000;
    scratch_folder_enter(NULL);
    fuzz_write_seed("seed");
    size_t seed_size;
    unsigned char *seed = scratch_load("seed", &seed_size), *bytes = malloc(seed_size);
    if (!bytes)
        abort();
    for (int i = 0; i < iterations; i++) {
        size_t size = seed_size;
        memcpy(bytes, seed, seed_size);
        for (size_t edits = 1 + random_below(4); edits > 0; edits--)
            mutate_once(bytes, &size);
        LLVMFuzzerTestOneInput(bytes, size);
    }
    free(bytes);
    free(seed);
    printf("%d mutations of %zu bytes\n", iterations, seed_size);
    return scratch_folder_leave(NULL);
}
