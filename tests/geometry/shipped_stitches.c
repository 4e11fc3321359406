#include "tests/geometry/shipped_stitches.h"

#include "tests/support/cmocka_all.h"
#include "tests/support/suite.h"

#include <stdio.h>

const char *const shipped_stitch[SHIPPED_STITCHES] = {"plain_knit", "purl_knit", "two_colour_loops", "plain_weave",
                                                      "twill",      "satin",     "open_weave",       "ribs"};

int shipped_stitch_step(void)
{
    return suite_argument ? 1 : SHIPPED_STITCHES / 2;
}

void shipped_stitch_open(const char *name, int resolution, weft_stitch *stitch, weft_tile_mesh *mesh)
{
    char path[512];
    weft_error error = {0};
    snprintf(path, sizeof path, "%s/stitches/%s.stitch", WEFT_ASSETS, name);
    if (weft_stitch_read(path, stitch, &error) != WEFT_OK)
        fail_msg("%s", error.message);
    if (weft_tile_mesh_create(stitch, resolution, path, mesh, &error) != WEFT_OK)
        fail_msg("%s", error.message);
}
