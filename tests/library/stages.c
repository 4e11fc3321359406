/* All stages through the public headers alone: a session becomes a dataset, a material and a picture, and each file is
 * described and checked. Usage: stages SESSION UNFINISHED, the second a session whose plan is not complete. */
#include <weft/weft.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static weft_error error;

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "stages.c:%d: %s: %s\n", __LINE__, #condition, error.message);                             \
            exit(1);                                                                                                   \
        }                                                                                                              \
    } while (0)

/* How often a stage reported, and whether it stayed within its total. */
typedef struct reports {
    long count, bad;
} reports;

static void count_report(void *context, const char *stage, long done, long total)
{
    reports *r = context;
    r->count++;
    r->bad += !stage || done < 0 || done > total;
}

static void count_line(void *context, const char *text)
{
    *(int *)context += strchr(text, '\n') == NULL;
}

static void exists(const char *path, int expected)
{
    FILE *file = fopen(path, "rb");
    CHECK((file != NULL) == expected);
    if (file)
        fclose(file);
}

/* weft_info and weft_check give an object with this word in it; the second may count what it read. */
static void described(const char *path, const char *word, bool is_counted)
{
    char *json = NULL;
    CHECK(weft_info(path, &json, &error) == WEFT_OK && json[0] == '{' && strstr(json, word));
    CHECK(!strstr(json, "\"verified\""));
    free(json);
    CHECK(weft_check(path, NULL, &json, &error) == WEFT_OK && strstr(json, word));
    CHECK((strstr(json, "\"verified\"") != NULL) == is_counted);
    free(json);
}

static void register_session(const char *session, const char *unfinished)
{
    reports r = {0};
    const weft_progress progress = {count_report, &r};
    weft_register_options options = {.width = 8, .height = 8};
    weft_register_report report;
    CHECK(weft_register(session, "made.btf.h5", &options, &progress, &report, &error) == WEFT_OK);
    CHECK(report.camera_count == 1 && report.photograph_count == 4 && report.used_count == 4);
    CHECK(report.viewpoint_count == 2 && report.registered_count == 2);
    CHECK(r.count > 0 && r.bad == 0);
    CHECK(weft_class_of(weft_register("absent", "none.btf.h5", NULL, NULL, NULL, &error)) == WEFT_BAD_INPUT);
    CHECK(strstr(error.message, "absent"));
    CHECK(weft_class_of(weft_register(unfinished, "none.btf.h5", &options, NULL, NULL, &error)) == WEFT_BAD_INPUT);
    exists("none.btf.h5", 0);
    options.allow_unfinished = true;
    CHECK(weft_register(unfinished, "part.btf.h5", &options, NULL, &report, &error) == WEFT_OK);
    CHECK(report.used_count < 4 && report.used_count > 0);
    described(session, "\"session\"", true);
    described("made.btf.h5", "\"dataset\"", true);
}

static void fit(const weft_compress_options *options, int components, int lobes, const char *path)
{
    weft_dataset *dataset;
    weft_material *material;
    CHECK(weft_dataset_open("made.btf.h5", &dataset, &error) == WEFT_OK);
    CHECK(weft_material_fit(dataset, options, NULL, &material, &error) == WEFT_OK);
    CHECK(weft_material_component_count(material) == components && weft_material_lobe_count(material) == lobes);
    CHECK(weft_material_width(material, 0) == 8 && weft_material_level_count(material) == (options->levels ? 4 : 1));
    CHECK(weft_material_texel_pitch_mm(material) > 0 && weft_material_metadata(material)[0] == '{');
    CHECK(weft_material_write(path, material, &error) == WEFT_OK);
    weft_material_close(material);
    weft_dataset_close(dataset);
    described(path, "\"material\"", false);
}

static void compress_dataset(void)
{
    weft_dataset *dataset;
    weft_material *material = NULL;
    weft_compress_options options = weft_compress_default_options();
    options.component_count = 4;
    fit(&options, 4, 0, "components.weft");
    options.component_count = 0;
    options.lobe_count = 1;
    options.levels = false;
    fit(&options, 0, 1, "lobes.weft");
    CHECK(weft_dataset_open("made.btf.h5", &dataset, &error) == WEFT_OK);
    options.component_count = 5;
    CHECK(weft_material_fit(dataset, &options, NULL, &material, &error) == WEFT_BAD_USAGE && !material);
    options.component_count = 4;
    options.held_out = (const uint8_t[]){1, 1, 1, 1};
    CHECK(weft_material_fit(dataset, &options, NULL, &material, &error) == WEFT_BAD_USAGE && !material);
    weft_dataset_close(dataset);
}

static void draw(void)
{
    int lines = 0;
    const weft_log log = {count_line, &lines};
    const char *options[] = {"material=components.weft", "mesh=plane", "size=32x24", "samples=1", NULL};
    weft_code code = weft_render(options, "picture.png", NULL, &log, &error);
    if (code == WEFT_SYSTEM) {
        printf("skipped the picture: %s\n", error.message);
        return;
    }
    CHECK(code == WEFT_OK);
    exists("picture.png", 1);
    const char *const raw[] = {"raw=made.btf.h5", "raw-format=rgb9e5", "mesh=plane", "size=32x24", "samples=1", NULL};
    CHECK(weft_render(raw, "raw.exr", NULL, &log, &error) == WEFT_OK && lines > 0);
    exists("raw.exr", 1);
    options[2] = "size=none";
    CHECK(weft_render(options, "none.png", NULL, NULL, &error) == WEFT_BAD_USAGE && strstr(error.message, "size"));
    options[2] = "unknown=1";
    CHECK(weft_render(options, "none.png", NULL, NULL, &error) == WEFT_BAD_USAGE && strstr(error.message, "unknown"));
    options[0] = "material=absent.weft";
    options[2] = "size=32x24";
    CHECK(weft_class_of(weft_render(options, "none.png", NULL, NULL, &error)) == WEFT_BAD_INPUT);
    exists("none.png", 0);
}

/* The first `share` of a file, the last byte of which is turned over. */
static void damage(const char *from, const char *to, double share)
{
    static char bytes[1 << 20];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    CHECK(in && out);
    size_t count = (size_t)(share * (double)fread(bytes, 1, sizeof bytes, in));
    bytes[count - 1] ^= 1;
    CHECK(fwrite(bytes, 1, count, out) == count);
    fclose(in);
    fclose(out);
}

static void refuse(void)
{
    char *json = NULL;
    CHECK(weft_info("absent.weft", &json, &error) == WEFT_MISSING && !json && strstr(error.message, "absent.weft"));
    CHECK(weft_check("absent.weft", NULL, &json, &error) == WEFT_MISSING && !json);
    damage("components.weft", "cut.weft", 0.6);
    CHECK(weft_info("cut.weft", &json, &error) == WEFT_DAMAGED && !json);
    damage("components.weft", "turned.weft", 1);
    CHECK(weft_check("turned.weft", NULL, &json, &error) == WEFT_DAMAGED && !json);
    CHECK(strstr(error.message, "turned.weft"));
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return 2;
    register_session(argv[1], argv[2]);
    compress_dataset();
    draw();
    refuse();
    printf("all stages passed\n");
    return 0;
}
