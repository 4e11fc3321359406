#include "registration/resample/overlap.h"

#include <math.h>

enum { corners_limit = 8 }; /* a quadrangle gains at most one corner at each of four cuts */

typedef struct polygon {
    int count;
    weft_pixel corner[corners_limit];
} polygon;

/* Keeps the part where sign * (coordinate - limit) >= 0; `vertical` chooses y. */
static polygon cut(const polygon *whole, int vertical, double limit, double sign)
{
    polygon part = {0};
    for (int i = 0; i < whole->count; i++) {
        weft_pixel a = whole->corner[i], b = whole->corner[(i + 1) % whole->count];
        double da = sign * ((vertical ? a.y : a.x) - limit), db = sign * ((vertical ? b.y : b.x) - limit);
        if (da >= 0)
            part.corner[part.count++] = a;
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            double t = da / (da - db);
            part.corner[part.count++] = (weft_pixel){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        }
    }
    return part;
}

/* Shoelace formula about the first corner. */
static double area_of(const polygon *p)
{
    double twice = 0;
    for (int i = 1; i + 1 < p->count; i++) {
        double ax = p->corner[i].x - p->corner[0].x, ay = p->corner[i].y - p->corner[0].y;
        double bx = p->corner[i + 1].x - p->corner[0].x, by = p->corner[i + 1].y - p->corner[0].y;
        twice += ax * by - ay * bx;
    }
    return 0.5 * fabs(twice);
}

double weft_overlap_area(const weft_pixel corner[4], int x, int y)
{
    polygon p = {4, {corner[0], corner[1], corner[2], corner[3]}};
    p = cut(&p, 0, x - 0.5, 1);
    p = cut(&p, 0, x + 0.5, -1);
    p = cut(&p, 1, y - 0.5, 1);
    p = cut(&p, 1, y + 0.5, -1);
    return area_of(&p);
}
