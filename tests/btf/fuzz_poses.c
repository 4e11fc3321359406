#include "btf/session/poses_file.h"
#include "tests/support/fuzz.h"

#include <math.h>
#include <stdlib.h>

void fuzz_write_seed(const char *path)
{
    const weft_camera camera = {.width = 416, .height = 416, .fx = 1920, .fy = 1920, .cx = 207.5, .cy = 207.5};
    weft_poses_file file = {.poses = weft_rig_poses_nominal(&camera, 500), .rms_px = 0.5, .scatter_mm = 0.1};
    const weft_lens_photograph shot[] = {{"a.tif", NULL}, {"b.tif", "the target is not found"}};
    const char *const undetermined[] = {"sample phi does not turn"};
    file.poses.joint[1].uneven[1] = 0.001;
    if (weft_poses_write(path, &file, shot, 2, undetermined, 1, NULL) != WEFT_OK)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    weft_poses_file file;
    weft_error error = {0};
    weft_code code = weft_poses_read(fuzz_file(bytes, size), &file, &error);
    if (code != WEFT_OK && (error.code != code || !error.message[0]))
        abort();
    /* What was read can be computed with. */
    const weft_turns turns = {{75, -170, 30}};
    weft_pose pose = weft_rig_poses_at(&file.poses, &turns);
    if (code == WEFT_OK && !isfinite(pose.translation.x + pose.translation.y + pose.translation.z))
        abort();
    return 0;
}
