#include "btf/direction/direction.h"
#include "geometry/yarn/tile_mesh.h"
#include "reflectance/microcylinder/file.h"
#include "reflectance/weave/weave.h"
#include "tests/golden/print.h"

/* ---- Weave ---- */

static void print_segment(FILE *out, const weft_yarn *yarn)
{
    const weft_segment *s = &yarn->segment;
    fprintf(out, "  psi_deg %.9g umax_deg %.9g kappa %.9g width %.9g length %.9g\n", weft_deg_of_rad(s->psi),
            weft_deg_of_rad(s->umax), s->kappa, s->width, s->length);
    fprintf(out, "  alpha %.9g beta %.9g ss %.9g hWidth %.9g frozen %d\n", s->alpha, s->beta, s->delta,
            s->highlight_width, s->frozen_radius);
}

static void print_weave_yarn(FILE *out, const weft_weave *weave, int index)
{
    const weft_yarn *yarn = &weave->yarn[index];
    fprintf(out, "yarn %d: %s, %s, centre %.9g %.9g\n", index + 1, yarn->warp ? "warp" : "weft",
            yarn->admissible ? "with a highlight" : "without one", yarn->center_u, yarn->center_v);
    print_segment(out, yarn);
    fprintf(out, "  kd");
    print_colour(out, yarn->kd);
    fprintf(out, " ks");
    print_colour(out, yarn->ks);
    fprintf(out, " cells %.9g area weight %.9g\n", yarn->cell_fraction, yarn->area_weight);
}

static void print_pattern(FILE *out, const weft_weave *weave)
{
    for (int row = 0; row < weave->tile_height; row++) {
        fprintf(out, "pattern:");
        for (int column = 0; column < weave->tile_width; column++)
            fprintf(out, " %d", weave->pattern[row * weave->tile_width + column] + 1);
        fputc('\n', out);
    }
}

weft_code print_weave(const char *path, FILE *out, weft_error *error)
{
    weft_weave weave;
    char warning[WEFT_MESSAGE_SIZE];
    WEFT_TRY(weft_weave_read(path, NULL, 0, &weave, warning, error));
    const weft_real *noise = weave.inclination_noise_deg;
    fprintf(out, "name: %s\nwarning: %s\n", weave.name, warning);
    fprintf(out, "areas: %.9g %.9g fineness %.9g period %.9g inclination_deg %.9g %.9g %.9g %.9g\n", weave.warp_area,
            weave.weft_area, weave.fineness, weave.period, noise[0], noise[1], noise[2], noise[3]);
    fprintf(out, "tiles: %.9g %.9g corner %.9g %.9g\n", weave.layout.tiles_u, weave.layout.tiles_v,
            weave.layout.corner_u, weave.layout.corner_v);
    fprintf(out, "specular_scale: %.9g\n", weave.specular_scale);
    if (weave.cell_pitch_mm > 0) /* a key that the first files do not have */
        fprintf(out, "cell_pitch_mm: %.9g\n", weave.cell_pitch_mm);
    print_pattern(out, &weave);
    for (int i = 0; i < weave.yarn_count; i++)
        print_weave_yarn(out, &weave, i);
    weft_weave_free(&weave);
    return WEFT_OK;
}

/* ---- Stitch ---- */

static void print_stitch_yarn(FILE *out, const weft_stitch_yarn *yarn, int index)
{
    fprintf(out, "yarn %d: radius %.9g %.9g plies %d twist %.9g fibre_twist %.9g tiles %d %d\n", index + 1,
            yarn->radius_side, yarn->radius_up, yarn->plies, yarn->twist, yarn->fibre_twist, yarn->tiles_x,
            yarn->tiles_y);
    fprintf(out, "  diffuse");
    print_colour(out, yarn->fibre.diffuse);
    fprintf(out, " specular");
    print_colour(out, yarn->fibre.specular);
    fprintf(out, " highlight_deg %.9g index %.9g\n", weft_deg_of_rad(yarn->fibre.highlight_rad),
            yarn->fibre.refractive_index);
    for (int i = 0; i < yarn->point_count; i++) {
        fprintf(out, "  point");
        print_vector(out, yarn->point[i]);
        fputc('\n', out);
    }
    for (int i = 0; i < yarn->copy_count; i++) {
        fprintf(out, "  copy");
        print_vector(out, yarn->copy[i]);
        fputc('\n', out);
    }
}

/* Of the triangles of a yarn: what a change of its shape cannot leave alone. */
static void print_surface(FILE *out, const weft_tile_mesh *mesh, int yarn)
{
    double area = 0, volume = 0;
    for (int i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corner = mesh->triangle[i];
        weft_vec3 at[3];
        for (int k = 0; k < 3; k++) {
            const float *p = mesh->position[corner[k]];
            at[k] = weft_vec3_of(p[0], p[1], p[2]);
        }
        if (mesh->yarn[corner[0]] != yarn)
            continue;
        weft_vec3 twice = weft_cross(weft_subtract(at[1], at[0]), weft_subtract(at[2], at[0]));
        area += 0.5 * weft_length(twice);
        volume += (at[0].z + at[1].z + at[2].z) / 6 * twice.z;
    }
    fprintf(out, "surface of yarn %d: %.3g mm2 round %.3g mm3\n", yarn + 1, area, volume);
}

/* Mean sine of the angle by which fibres lean round their yarn, seen from outside: what the twists make. */
static double lean_of(const weft_stitch *stitch, const weft_tile_mesh *mesh, int yarn)
{
    const weft_stitch_yarn *y = &stitch->yarn[yarn];
    weft_vec3 along = weft_unit(weft_vec3_of(y->tiles_x * stitch->width, y->tiles_y * stitch->height, 0));
    double sum = 0;
    int count = 0;
    for (int i = 0; i < mesh->vertex_count; i++) {
        if (mesh->yarn[i] != yarn)
            continue;
        const float *n = mesh->normal[i], *f = mesh->tangent[i];
        weft_vec3 fibre = weft_vec3_of(f[0], f[1], f[2]), round = weft_cross(weft_vec3_of(n[0], n[1], n[2]), along);
        sum += weft_dot(fibre, along) < 0 ? -weft_dot(fibre, round) : weft_dot(fibre, round);
        count++;
    }
    return sum / count;
}

static weft_code print_mesh(const weft_stitch *stitch, const char *path, FILE *out, weft_error *error)
{
    weft_tile_mesh mesh;
    WEFT_TRY(weft_tile_mesh_create(stitch, 0, path, &mesh, error));
    fprintf(out, "bottom and top: %.3g %.3g\n", mesh.bottom, mesh.top);
    for (int i = 0; i < stitch->yarn_count; i++)
        print_surface(out, &mesh, i);
    for (int i = 0; i < stitch->yarn_count; i++)
        if (stitch->yarn[i].tiles_x != 0 || stitch->yarn[i].tiles_y != 0)
            fprintf(out, "lean of the fibres of yarn %d: %.3g\n", i + 1, lean_of(stitch, &mesh, i));
    weft_tile_mesh_free(&mesh);
    return WEFT_OK;
}

weft_code print_stitch(const char *path, FILE *out, weft_error *error)
{
    weft_stitch stitch;
    WEFT_TRY(weft_stitch_read(path, &stitch, error));
    fprintf(out, "name: %s\ntile_mm: %.9g %.9g resolution: %d blend_mm: %.9g\n", stitch.name, stitch.width,
            stitch.height, stitch.resolution, stitch.blend);
    for (int i = 0; i < stitch.yarn_count; i++)
        print_stitch_yarn(out, &stitch.yarn[i], i);
    weft_code code = print_mesh(&stitch, path, out, error);
    weft_stitch_free(&stitch);
    return code;
}

/* ---- Microcylinder cloth ---- */

static void print_thread(FILE *out, const weft_cloth_thread *thread, int index)
{
    const weft_thread_optics *o = &thread->optics;
    fprintf(out, "thread %d: along %s, samples %d area %.9g\n  tilts_deg", index + 1,
            thread->axis == WEFT_AXIS_X ? "x" : "y", thread->sample_count, thread->area_share);
    for (int i = 0; i < thread->point_count; i++)
        fprintf(out, " %.9g", weft_deg_of_rad(thread->tilt_rad[i]));
    fprintf(out, " lengths");
    for (int i = 0; i + 1 < thread->point_count; i++)
        fprintf(out, " %.9g", thread->piece_length[i]);
    fprintf(out, "\n  eta %.9g gammaS_deg %.9g gammaV_deg %.9g kd %.9g albedo", o->eta, weft_deg_of_rad(o->gamma_s),
            weft_deg_of_rad(o->gamma_v), o->kd);
    print_colour(out, o->albedo);
    fputc('\n', out);
}

weft_code print_microcylinder(const char *path, FILE *out, weft_error *error)
{
    weft_microcylinder_description description;
    WEFT_TRY(weft_microcylinder_read(path, NULL, 0, &description, error));
    fprintf(out, "name: %s\nsigma_deg: %.9g\n", description.name, weft_deg_of_rad(description.cloth.sigma));
    for (int i = 0; i < WEFT_CLOTH_THREADS; i++)
        print_thread(out, &description.cloth.thread[i], i);
    return WEFT_OK;
}
