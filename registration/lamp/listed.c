#include "registration/lamp/listed.h"

#include "base/numeric/statistics.h"

#include <math.h>
#include <stdlib.h>

static const double usual_deviation_deg = 1, nearest_mm = 20, deviations = 2.5;

/* How an .lp file may count its axes; all but the first are mistakes that are made. */
typedef enum axes { AS_SHOWN, Y_DOWN, AS_STORED, OF_SAMPLE, AXES_COUNT } axes;

static const char *const axes_name[AXES_COUNT] = {"as documented", "if their y points down",
                                                  "if the pictures are not turned by their Exif orientation",
                                                  "if their axes are those of the sheet"};

/* ---- From the list to the plate ---- */

/* Right and up of the picture as it is shown, in the pixels of the file, whose y points down (Exif 2.3). */
static void shown_axes(int orientation, double right[2], double up[2])
{
    static const double both[4][4] = {{1, 0, 0, -1}, {-1, 0, 0, 1}, {0, -1, -1, 0}, {0, 1, 1, 0}};
    int which = orientation == 3 ? 1 : orientation == 6 ? 2 : orientation == 8 ? 3 : 0;
    right[0] = both[which][0], right[1] = both[which][1];
    up[0] = both[which][2], up[1] = both[which][3];
}

/* From the frame of the picture to that of the plate; z of the former points against that of the camera. */
static weft_vec3 from_picture(const weft_photographs_photograph *p, weft_vec3 light, axes counted)
{
    double right[2], up[2];
    const double(*r)[3] = p->pose.rotation;
    shown_axes(counted == AS_STORED ? 1 : p->exif.orientation, right, up);
    double y = counted == Y_DOWN ? -light.y : light.y;
    double camera[3] = {light.x * right[0] + y * up[0], light.x * right[1] + y * up[1], -light.z};
    double plate[3];
    for (int axis = 0; axis < 3; axis++)
        plate[axis] = r[0][axis] * camera[0] + r[1][axis] * camera[1] + r[2][axis] * camera[2];
    return weft_vec3_of(plate[0], plate[1], plate[2]);
}

static weft_listed_lamp lamp_of(const weft_light_list *list, const weft_photographs_photograph *p, axes counted)
{
    int row = weft_light_list_find(list, p->name);
    if (row < 0 || !list->row[row].has_light)
        return (weft_listed_lamp){0};
    const weft_listed_light *listed = &list->row[row];
    double deviation_deg = listed->uncertainty_deg > 0 ? listed->uncertainty_deg : usual_deviation_deg;
    bool turned = list->of_pictures && counted != OF_SAMPLE;
    return (weft_listed_lamp){true, list->positions, turned ? from_picture(p, listed->light, counted) : listed->light,
                              weft_rad_of_deg(deviation_deg)};
}

weft_listed_lamp weft_listed_lamp_of(const weft_light_list *list, const weft_photographs_photograph *photograph)
{
    return lamp_of(list, photograph, AS_SHOWN);
}

weft_code weft_listed_check(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                            weft_error *error)
{
    int named = 0;
    for (int i = 0; i < list->count && list->positions; i++) {
        const weft_listed_light *row = &list->row[i];
        double length = weft_length(row->light);
        if (row->has_light && length < nearest_mm)
            return weft_fail(error, WEFT_BAD_INPUT,
                             "%s:%d: a lamp of length %g is neither a direction (1) nor a position in mm", list->path,
                             row->line, length);
    }
    for (int i = 0; i < count; i++)
        named += weft_light_list_find(list, photograph[i].name) >= 0;
    if (named == 0)
        return weft_fail(error, WEFT_BAD_INPUT,
                         "'%s' lists none of the photographs; it names '%s', the folder holds '%s'", list->path,
                         list->row[0].file, count > 0 ? photograph[0].name : "");
    return WEFT_OK;
}

/* ---- Against what the photographs tell ---- */

static double angle_deg(weft_vec3 a, weft_vec3 b)
{
    return weft_deg_of_rad(acos(weft_clamp(weft_dot(weft_unit(a), weft_unit(b)), -1, 1)));
}

/* Median angle between the lamps listed and found. */
static double median_angle_deg(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                               axes counted, double *scratch)
{
    size_t compared = 0;
    for (int i = 0; i < count; i++) {
        weft_listed_lamp lamp = lamp_of(list, &photograph[i], counted);
        if (weft_photographs_used(&photograph[i]) && lamp.found)
            scratch[compared++] = angle_deg(lamp.light, photograph[i].lamp.position_mm);
    }
    return weft_quantile(scratch, compared, 0.5);
}

static double limit_deg(const weft_listed_lamp *lamp, const weft_photographs_photograph *p)
{
    return deviations * hypot(weft_deg_of_rad(lamp->deviation_rad), p->lamp.uncertainty_deg);
}

static bool lamp_differs(const weft_listed_lamp *lamp, const weft_photographs_photograph *p)
{
    return weft_photographs_used(p) && lamp->found && angle_deg(lamp->light, p->lamp.position_mm) > limit_deg(lamp, p);
}

static weft_code note_axes(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                           double *scratch, weft_lines *notes, weft_error *error)
{
    double median[AXES_COUNT];
    int best = AS_SHOWN;
    for (int counted = AS_SHOWN; counted < AXES_COUNT; counted++) {
        median[counted] = median_angle_deg(list, photograph, count, (axes)counted, scratch);
        if (median[counted] < median[best] / 3)
            best = counted;
    }
    if (best == AS_SHOWN || !list->of_pictures)
        return weft_lines_add(notes, error, "'%s': its lamps lie %.1f degrees from those in the photographs, median",
                              list->path, median[AS_SHOWN]);
    return weft_lines_add(notes, error, "'%s': its lamps lie %.1f degrees from those in the photographs, but %.1f %s",
                          list->path, median[AS_SHOWN], median[best], axes_name[best]);
}

static weft_code compare_lamps(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                               double *scratch, weft_lines *notes, weft_error *error)
{
    int differing = 0, compared = 0;
    for (int i = 0; i < count; i++) {
        weft_listed_lamp lamp = weft_listed_lamp_of(list, &photograph[i]);
        compared += weft_photographs_used(&photograph[i]) && lamp.found;
        differing += lamp_differs(&lamp, &photograph[i]);
    }
    if (compared >= 3 && 2 * differing > compared)
        return note_axes(list, photograph, count, scratch, notes, error);
    for (int i = 0; i < count && differing > 0; i++) {
        const weft_photographs_photograph *p = &photograph[i];
        weft_listed_lamp lamp = weft_listed_lamp_of(list, p);
        if (lamp_differs(&lamp, p))
            WEFT_TRY(weft_lines_add(notes, error,
                                    "'%s': its lamp is %.1f degrees from that in %s:%d, expected within %.1f", p->name,
                                    angle_deg(lamp.light, p->lamp.position_mm), list->path,
                                    list->row[weft_light_list_find(list, p->name)].line, limit_deg(&lamp, p)));
    }
    return WEFT_OK;
}

static const weft_listed_light *listed_view(const weft_light_list *list, const weft_photographs_photograph *p)
{
    int row = weft_photographs_used(p) ? weft_light_list_find(list, p->name) : -1;
    return row >= 0 && list->row[row].has_view ? &list->row[row] : NULL;
}

static weft_vec3 turned(weft_vec3 v, double angle)
{
    return weft_vec3_of(v.x * cos(angle) - v.y * sin(angle), v.x * sin(angle) + v.y * cos(angle), v.z);
}

static double view_angle_deg(const weft_photographs_photograph *p, const weft_listed_light *row, double turn)
{
    return angle_deg(weft_pose_camera_position(&p->pose), turned(row->view, turn));
}

/* The turn of the table against the sheet: that of the photograph whose turn suits the others best. */
static double find_turn(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                        double *scratch)
{
    double least = INFINITY, best = 0;
    for (int i = 0; i < count; i++) {
        const weft_listed_light *row = listed_view(list, &photograph[i]);
        if (!row)
            continue;
        weft_vec3 eye = weft_pose_camera_position(&photograph[i].pose);
        double turn = atan2(eye.y, eye.x) - atan2(row->view.y, row->view.x);
        size_t compared = 0;
        for (int k = 0; k < count; k++) {
            const weft_listed_light *other = listed_view(list, &photograph[k]);
            if (other)
                scratch[compared++] = view_angle_deg(&photograph[k], other, turn);
        }
        double median = weft_quantile(scratch, compared, 0.5);
        if (median < least)
            least = median, best = turn;
    }
    return best;
}

static weft_code compare_views(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                               double *scratch, weft_lines *notes, weft_error *error)
{
    double turn = find_turn(list, photograph, count, scratch);
    for (int i = 0; i < count; i++) {
        const weft_listed_light *row = listed_view(list, &photograph[i]);
        double limit = deviations * usual_deviation_deg, angle = row ? view_angle_deg(&photograph[i], row, turn) : 0;
        if (angle > limit)
            WEFT_TRY(weft_lines_add(notes, error,
                                    "'%s': its view is %.1f degrees from that in %s:%d, expected within %.1f",
                                    photograph[i].name, angle, list->path, row->line, limit));
    }
    return WEFT_OK;
}

static weft_code note_absent(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                             weft_lines *notes, weft_error *error)
{
    int absent = list->count, unlisted = 0, first = -1;
    for (int i = 0; i < count; i++) {
        if (weft_light_list_find(list, photograph[i].name) >= 0)
            absent--;
        else if (unlisted++ == 0)
            first = i;
    }
    if (unlisted > 0)
        WEFT_TRY(weft_lines_add(notes, error, "%d photographs are not in '%s', such as '%s'", unlisted, list->path,
                                photograph[first].name));
    return absent > 0 ? weft_lines_add(notes, error, "%d rows of '%s' have no photograph", absent, list->path)
                      : WEFT_OK;
}

weft_code weft_listed_compare(const weft_light_list *list, const weft_photographs_photograph *photograph, int count,
                              weft_lines *notes, weft_error *error)
{
    double *scratch = malloc(((size_t)count + 1) * sizeof *scratch);
    if (!scratch)
        return weft_fail_memory(error, "angles", (size_t)count * sizeof *scratch);
    weft_code code = note_absent(list, photograph, count, notes, error);
    for (int i = 0; code == WEFT_OK && i < list->notes.count; i++)
        code = weft_lines_add(notes, error, "%s", list->notes.line[i]);
    if (code == WEFT_OK)
        code = compare_lamps(list, photograph, count, scratch, notes, error);
    if (code == WEFT_OK)
        code = compare_views(list, photograph, count, scratch, notes, error);
    free(scratch);
    return code;
}
