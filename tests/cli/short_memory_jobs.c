#include "tests/cli/short_memory_jobs.h"

#include "base/atomic_file.h"
#include "base/picture/image.h"
#include "tests/compare/fixture.h"
#include "tests/geometry/stitch_text.h"
#include "tests/support/chart_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define CLOTH WEFT_ASSETS "/microcylinder/plain_matte.mc"
#define BONN WEFT_ASSETS "/../tests/golden/good/bonn/"

const short_memory_job short_memory_inputs[] = {
    {"session",
     ALL_OR_NOTHING,
     {"capture", "--rig", "rig.json", "--sample", "plain.wv", "--plan", "plan.csv", "-o", "session", "--truth-images",
      "1", "--truth-size", "4"}},
    {"series",
     ALL_OR_NOTHING,
     {"capture", "--rig", "axes.json", "--sample", "plain.wv", "--plan", "series.csv", "-o", "series", "--truth-images",
      "1", "--truth-size", "4"}},
    {"knit",
     ALL_OR_NOTHING,
     {"simulate", "coarse.stitch", "-o", "knit.btf.h5", "--plane", "top", "--size", "2x2", "--noise", "50",
      "--directions", "few.csv"}},
    {"material", ALL_OR_NOTHING, {"compress", "small.btf.h5", "-o", "small.weft", "--lobes", "2"}},
    {"chosen", ALL_OR_NOTHING, {"compress", "small.btf.h5", "-o", "chosen.weft", "--components", "4"}},
    {"wide", ALL_OR_NOTHING, {"compress", "wide.btf.h5", "-o", "wide.weft", "--components", "4", "--hold-out", "off"}},
    {"sparse", ALL_OR_NOTHING, {"compress", "card.btf.h5", "-o", "card.weft"}},
    {"prediction", ALL_OR_NOTHING, {"bard", "small.btf.h5", "-o", "small.bard.h5"}},
    {"photographed",
     ALL_OR_NOTHING,
     {"synthetic", "checker", "-o", "taken", "--photographs", "3", "--width", "600", "--set", "tripod", "--truth-size",
      "0"}},
    {"picture", ALL_OR_NOTHING, {"render", "small.weft", "-o", "small.png", "--size", "32x32", "--samples", "1"}},
    {NULL, ALL_OR_NOTHING, {NULL}},
};

#define IN "../inputs/"

const short_memory_job short_memory_jobs[] = {
    {"capture",
     GOES_ON,
     {"capture", "--rig", IN "rig.json", "--sample", IN "plain.wv", "--plan", IN "plan.csv", "-o", "session",
      "--truth-images", "1", "--truth-size", "4"}},
    {"capture-stitch",
     GOES_ON,
     {"capture", "--rig", IN "rig.json", "--sample", IN "coarse.stitch", "--plan", IN "one.csv", "-o", "session",
      "--truth-images", "1", "--truth-size", "4"}},
    {"simulate",
     ALL_OR_NOTHING,
     {"simulate", IN "coarse.stitch", "-o", "knit.btf.h5", "--plane", "top", "--size", "2x2", "--noise", "50",
      "--directions", IN "few.csv", "--obj", "knit.obj"}},
    {"register",
     ALL_OR_NOTHING,
     {"register", IN "session", "-o", "cloth.btf.h5", "--size", "4x4", "--report", "report"}},
    {"import", ALL_OR_NOTHING, {"import", IN "named", "-o", "card.btf.h5", "--size", "2"}},
    {"import-listed", ALL_OR_NOTHING, {"import", IN "listed", "-o", "card.btf.h5"}},
    {"import-placed", ALL_OR_NOTHING, {"import", IN "placed", "-o", "card.btf.h5"}},
    {"import-lit", ALL_OR_NOTHING, {"import", IN "lit", "-o", "card.btf.h5"}},
    {"import-bonn", ALL_OR_NOTHING, {"import", BONN "rgb_frames.btf", "-o", "card.btf.h5", "--size", "2"}},
    {"import-joint", ALL_OR_NOTHING, {"import", BONN "joint_log.btf", "-o", "card.btf.h5"}},
    {"target", ALL_OR_NOTHING, {"target", "-o", "target.svg"}},
    {"target-pdf", ALL_OR_NOTHING, {"target", "-o", "target.pdf"}},
    {"synthetic",
     GOES_ON,
     {"synthetic", "checker", "-o", "taken", "--photographs", "1", "--width", "300", "--set", "tripod", "--truth-size",
      "4"}},
    {"photographs",
     ALL_OR_NOTHING,
     {"photographs", IN "taken", "-o", "felt.btf.h5", "--size", "8x8", "--lights", IN "taken.lp", "--report",
      "report"}},
    {"calibrate",
     ALL_OR_NOTHING,
     {"calibrate", IN "series", "-o", "poses.json", "--plan", IN "one.csv", "--lens", "free"}},
    {"lens", ALL_OR_NOTHING, {"lens", IN "taken", "--board", "plate:50", "-o", "lens.json"}},
    {"colour", ALL_OR_NOTHING, {"colour", IN "chart.exr", "-o", "colour.json", "--model", "linear"}},
    {"compress", GOES_ON, {"compress", IN "small.btf.h5", "-o", "small.weft", "--lobes", "1"}},
    {"compress-screen",
     GOES_ON,
     {"compress", IN "small.btf.h5", "-o", "small.weft", "--lobes", "2", "--weights", "screen", "--hold-out", "off"}},
    {"compress-error", GOES_ON, {"compress", IN "small.btf.h5", "-o", "small.weft", "--error", "90"}},
    {"compress-budget",
     GOES_ON,
     {"compress", IN "small.btf.h5", "-o", "small.weft", "--budget", "0.1", "--hold-out", "off"}},
    {"compress-sparse", ALL_OR_NOTHING, {"compress", IN "card.btf.h5", "-o", "card.weft"}},
    {"compress-scattered",
     GOES_ON,
     {"compress", IN "card.btf.h5", "-o", "card.weft", "--components", "4", "--hold-out", "off"}},
    {"compress-given", GOES_ON, {"compress", IN "knit.btf.h5", "-o", "knit.weft", "--lobes", "1", "--hold-out", "off"}},
    {"bard", ALL_OR_NOTHING, {"bard", IN "small.btf.h5", "-o", "small.bard.h5"}},
    {"tile", ALL_OR_NOTHING, {"tile", IN "waves.btf.h5", "-o", "tile.btf.h5", "--weave", IN "plain.wv"}},
    {"tile-blend", ALL_OR_NOTHING, {"tile", IN "wide.weft", "--blend", "-o", "tile.weft"}},
    {"fit-weave", ALL_OR_NOTHING, {"fit-weave", IN "waves.btf.h5", "--weave", IN "plain.wv", "-o", "fitted.wv"}},
    {"compare",
     ALL_OR_NOTHING,
     {"compare", IN "small.btf.h5", IN "small.weft", "--bard", IN "small.bard.h5", "--weave", IN "plain.wv", "-o",
      "report"}},
    {"compare-few", ALL_OR_NOTHING, {"compare", IN "card.btf.h5", IN "card.weft", "-o", "report"}},
    {"render",
     ALL_OR_NOTHING,
     {"render", IN "small.weft", "--raw", IN "small.btf.h5", "--weave", IN "plain.wv", "--mode", "split", "--size",
      "64x32", "--samples", "1", "--environment", IN "sky.exr", "--shadows", "--light", "30,40", "-o", "picture.png"}},
    {"render-again", ALL_OR_NOTHING, {"render", "--settings", IN "small.png", "-o", "picture.exr"}},
    {"eval-material", PRINTS, {"eval", IN "small.weft", "--at", IN "at.csv"}},
    {"eval-dataset", PRINTS, {"eval", IN "small.btf.h5", "--at", IN "at.csv"}},
    {"eval-weave", PRINTS, {"eval", IN "plain.wv", "--at", IN "at.csv", "--noise", "3", "-o", "at.csv"}},
    {"eval-microcylinder", PRINTS, {"eval", CLOTH, "--at", IN "at.csv"}},
    {"info-material", PRINTS, {"info", IN "chosen.weft"}},
    {"info-dataset", PRINTS, {"info", IN "small.btf.h5", "--json"}},
    {"info-session", PRINTS, {"info", IN "session"}},
    {"info-weave", PRINTS, {"info", IN "plain.wv"}},
    {"info-stitch", PRINTS, {"info", IN "coarse.stitch"}},
    {"verify-material", PRINTS, {"verify", IN "chosen.weft"}},
    {"verify-dataset", PRINTS, {"verify", IN "small.btf.h5"}},
    {"verify-session", PRINTS, {"verify", IN "session"}},
    {"verify-microcylinder", PRINTS, {"verify", CLOTH}},
    {NULL, ALL_OR_NOTHING, {NULL}},
};

/* ---- What no command writes ---- */

/* Of one kind of yarn: the scale of its highlights is found in a quarter of the time. */
static const char weave_text[] =
    "weave { name = \"Plain\", tileWidth = 1, tileHeight = 1, alpha = 0.02, beta = 3, ss = 0.5, hWidth = 0.5,\n"
    "  warpArea = 1, weftArea = 1, dWarpUmaxOverDWarp = 8, period = 50, fineness = 3, pattern { 1 },\n"
    "  yarn { type = warp, psi = -30, umax = 30, kappa = -0.5, width = 1, length = 1,\n"
    "    centerU = 0.5, centerV = 0.5, kd = {0.1, 0.2, 0.3}, ks = {0.4, 0.5, 0.6} } }\n";

static void write_text(const char *path, const char *text)
{
    weft_error error = {0};
    expect_ok(weft_write_file(path, text, strlen(text), &error), &error);
}

/* Two waves of 4 and 6 texels, and a highlight. */
static weft_rgb waves(int x, int y, weft_vec3 light, weft_vec3 view)
{
    double wave = 0.3 + 0.1 * cos(WEFT_PI * x / 2) + 0.1 * sin(WEFT_PI * y / 3);
    double mirrored = fmax(0, 2 * light.z * view.z - weft_dot(light, view)), shine = 2 * pow(mirrored, 20);
    return (weft_rgb){wave + shine, 0.8 * wave + shine, 0.5 * wave + shine};
}

static void write_photograph(const char *folder, const char *name, float value)
{
    weft_image image;
    weft_error error = {0};
    expect_ok(weft_image_create(4, 4, &image, &error), &error);
    for (int i = 0; i < 3 * 4 * 4; i++)
        image.pixels[i] = value + 0.01f * (float)i;
    char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    expect_ok(weft_image_write(path, &image, NULL, &error), &error);
    weft_image_free(&image);
}

/* The three kinds of collections that import knows. */
static void write_collections(void)
{
    mkdir("named", 0777);
    write_photograph("named", "tl000_pl000_tv000_pv000.png", 0.2f);
    write_photograph("named", "tl030_pl000_tv000_pv000.png", 0.3f);
    write_photograph("named", "tl030_pl120_tv000_pv000.png", 0.1f);
    mkdir("listed", 0777);
    write_photograph("listed", "a.png", 0.2f);
    write_photograph("listed", "b.exr", 0.3f);
    write_text("listed/directions.csv",
               "file,theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\na.png,0,0,0,0\nb.exr,30,0,10,120\n");
    mkdir("lit", 0777);
    write_photograph("lit", "a.png", 0.2f);
    write_photograph("lit", "b.png", 0.3f);
    write_text("lit/dome.lp", "3\nB.PNG 0 0.6 0.8\na.png 0 0 1\ngone.png 0.6 0 0.8\n");
    mkdir("placed", 0777);
    write_photograph("placed", "00.png", 0.2f);
    write_photograph("placed", "01.png", 0.3f);
    write_text("placed/camera_pos.txt", "0,0,30\n5,-3,20\n");
    write_text("placed/light_pos.txt", "3,4,12\n-6,2,15\n");
    write_text("placed/light_power.txt", "500,600,700\n");
    write_text("placed/image_size.txt", "8\n");
}

void short_memory_write_inputs(void)
{
    fixture_far_dataset("waves.btf.h5", 12, 12, 2, waves, FIXTURE_MASK_ONE);
    fixture_far_dataset("small.btf.h5", 6, 6, 2, waves, FIXTURE_MASK_ONE);
    fixture_far_dataset("wide.btf.h5", 18, 17, 2, waves, FIXTURE_MASK_ONE);
    fixture_near_dataset("card.btf.h5", 4, 5, waves);
    write_collections();
    weft_image sky;
    weft_error error = {0};
    expect_ok(weft_image_create(16, 8, &sky, &error), &error);
    for (int i = 0; i < 3 * 16 * 8; i++)
        sky.pixels[i] = 0.5f + 0.01f * (float)(i % 16);
    expect_ok(weft_image_write("sky.exr", &sky, NULL, &error), &error);
    weft_image_free(&sky);
    const chart_picture chart = chart_picture_usual();
    chart_picture_write_exr(&chart, "chart.exr");
    write_text("at.csv", "lx,ly,lz,vx,vy,vz\n0,0,1,0,0.6,0.8\n0.6,0,0.8,0,0,1\n");
    write_text("few.csv", "theta_deg,phi_deg\n0,0\n40,0\n40,120\n");
    write_text("one.csv", "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n40,60,0,0\n");
    write_text("plan.csv", "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                           "0,0,0,0\n40,60,30,90\n");
    write_text("rig.json", "{\"rig\": \"virtual\", \"width_px\": 208, \"height_px\": 208, \"focal_length_px\": 960,"
                           " \"samples_per_pixel\": 1, \"bounces\": 1}");
    write_text("axes.json", "{\"rig\": \"virtual\", \"width_px\": 144, \"height_px\": 144, \"focal_length_px\": 660,"
                            " \"samples_per_pixel\": 2, \"axes\": 1, \"axis_tilt_deg\": 0.2}");
    write_text("series.csv", "theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n"
                             "30,60,0,0\n30,60,20,0\n30,60,20,120\n30,60,20,240\n"
                             "30,60,40,0\n30,60,40,120\n30,60,40,240\n30,60,60,180\n");
    write_text("coarse.stitch", STITCH_TEXT);
    write_text("plain.wv", weave_text);
}
