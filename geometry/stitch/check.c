/* Whether the yarns of a stitch are solids that keep out of each other. */
#include "geometry/stitch/segment_grid.h"

#include <stdbool.h>

#define MAX_BEND 0.98 /* curvature times the extent of the cross-section toward the centre of the bend */

static weft_real thin_radius(const weft_stitch_yarn *yarn)
{
    return fmin(yarn->radius_side, yarn->radius_up);
}

static weft_code check_bend(const weft_yarn_skeleton *skeleton, const char *path, const weft_yarn_strand *strand,
                            int station, weft_error *error)
{
    const weft_yarn_station *a = &skeleton->station[station], *b = a + 1;
    const weft_stitch_yarn *yarn = &skeleton->stitch->yarn[strand->yarn];
    weft_vec3 turn = weft_subtract(b->tangent, a->tangent), inward = weft_unit(turn);
    weft_real extent = hypot(weft_dot(inward, a->side) * yarn->radius_side, weft_dot(inward, a->up) * yarn->radius_up);
    weft_real length = weft_length(weft_subtract(b->at, a->at));
    if (weft_length(turn) * extent <= MAX_BEND * length)
        return WEFT_OK;
    return weft_stitch_fail_at(
        skeleton->stitch, path, strand->yarn, a->point, error,
        "after this point the yarn bends to a radius of %.3g mm at (%.3g, %.3g, %.3g) mm, it is %.3g mm "
        "thick there and crosses itself",
        length / weft_length(turn), a->at.x, a->at.y, a->at.z, extent);
}

static weft_code check_bends(const weft_yarn_skeleton *skeleton, const char *path, weft_error *error)
{
    for (int i = 0; i < skeleton->strand_count; i++)
        for (int k = 0; k + 1 < skeleton->strand[i].station_count; k++)
            WEFT_TRY(check_bend(skeleton, path, &skeleton->strand[i], skeleton->strand[i].first_station + k, error));
    return WEFT_OK;
}

/* Whether a segment is the same stretch of yarn as a station, `radius` being that of the yarn: it could not come nearer
 * without bending tighter than its radius. Counts round the period of the yarn too. */
static bool same_stretch(const weft_segment_grid *grid, int strand_index, const weft_yarn_station *station,
                         const weft_near_segment *near, weft_real radius)
{
    const weft_yarn_strand *strand = &grid->skeleton->strand[strand_index];
    if (near->strand != strand_index)
        return false;
    const weft_stitch_yarn *yarn = &grid->skeleton->stitch->yarn[strand->yarn];
    weft_real along = grid->skeleton->station[near->station].arclength - station->arclength;
    weft_real period = grid->skeleton->station[strand->first_station + strand->station_count - 1].arclength;
    for (int k = -1; k <= 1; k++) {
        /* The image of the segment that is k periods further on along the yarn through the station. */
        bool same_image = near->tiles_x == k * yarn->tiles_x && near->tiles_y == k * yarn->tiles_y;
        if (same_image && fabs(along + k * period) < 2 * radius)
            return true;
    }
    return false;
}

/* The images of the station and of the segments are counted from the tile that holds the station. */
static weft_code check_station(const weft_segment_grid *grid, const char *path, int strand_index, int index,
                               weft_error *error)
{
    const weft_stitch *stitch = grid->skeleton->stitch;
    const weft_yarn_station *station = &grid->skeleton->station[index];
    int yarn = grid->skeleton->strand[strand_index].yarn;
    weft_vec3 place = weft_place_in_tile(stitch, station->at);
    int tiles_x = (int)round((place.x - station->at.x) / stitch->width);
    int tiles_y = (int)round((place.y - station->at.y) / stitch->height);
    size_t count;
    const weft_near_segment *near = weft_segments_near(grid, place, &count);
    for (size_t i = 0; i < count; i++) {
        int other = grid->skeleton->strand[near[i].strand].yarn;
        weft_real radius = fmin(thin_radius(&stitch->yarn[yarn]), thin_radius(&stitch->yarn[other]));
        weft_real apart = weft_length(weft_subtract(station_place(grid, &near[i], near[i].station), place));
        weft_near_segment from_station = near[i];
        from_station.tiles_x -= tiles_x;
        from_station.tiles_y -= tiles_y;
        if (apart >= radius || same_stretch(grid, strand_index, station, &from_station, radius))
            continue;
        return weft_stitch_fail_at(
            stitch, path, yarn, station->point, error,
            "after this point the yarn runs through %s: at (%.3g, %.3g, %.3g) mm their centre lines are "
            "%.3g mm apart, less than the radius of %.3g mm",
            near[i].strand == strand_index ? "itself" : "another", station->at.x, station->at.y, station->at.z, apart,
            radius);
    }
    return WEFT_OK;
}

static weft_code check_crossings(const weft_segment_grid *grid, const char *path, weft_error *error)
{
    for (int i = 0; i < grid->skeleton->strand_count; i++) {
        const weft_yarn_strand *strand = &grid->skeleton->strand[i];
        for (int k = 0; k + 1 < strand->station_count; k++)
            WEFT_TRY(check_station(grid, path, i, strand->first_station + k, error));
    }
    return WEFT_OK;
}

weft_code weft_stitch_check(const weft_stitch *stitch, const char *path, weft_error *error)
{
    weft_yarn_skeleton skeleton;
    weft_segment_grid grid;
    WEFT_TRY(weft_yarn_skeleton_create(stitch, path, &skeleton, error));
    weft_code code = check_bends(&skeleton, path, error);
    if (code == WEFT_OK)
        code = weft_segment_grid_create(&skeleton, 0, path, &grid, error);
    if (code == WEFT_OK) {
        code = check_crossings(&grid, path, error);
        weft_segment_grid_free(&grid);
    }
    weft_yarn_skeleton_free(&skeleton);
    return code;
}
