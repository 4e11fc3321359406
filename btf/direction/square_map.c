#include "btf/direction/square_map.h"

weft_place weft_place_of_direction(weft_vec3 direction)
{
    weft_real scale = (weft_real)0.5 / (1 + fmax(direction.z, (weft_real)0));
    return (weft_place){(weft_real)0.5 + scale * direction.x, (weft_real)0.5 + scale * direction.y};
}

/* The larger of |x| and |y| keeps the radius; the other is in proportion to the angle from its axis, which is at most
 * pi / 4. */
weft_place weft_place_of_half_vector(weft_vec3 half_vector)
{
    weft_real across = fabs(half_vector.x), along = fabs(half_vector.y);
    weft_real radius = sqrt(fmax((weft_real)0, 1 - half_vector.z)) / 2;
    weft_real least = fmin(across, along), most = fmax(across, along);
    weft_real other = most > 0 ? radius * atan(least / most) / (WEFT_PI / 4) : 0;
    weft_real x = across >= along ? radius : other, y = across >= along ? other : radius;
    return (weft_place){(weft_real)0.5 + copysign(x, half_vector.x), (weft_real)0.5 + copysign(y, half_vector.y)};
}

weft_vec3 weft_direction_of_place(weft_place place)
{
    weft_real x = 2 * place.x - 1, y = 2 * place.y - 1, square = x * x + y * y;
    return (weft_vec3){2 * x / (1 + square), 2 * y / (1 + square), (1 - square) / (1 + square)};
}

weft_vec3 weft_half_vector_of_place(weft_place place)
{
    weft_real x = place.x - (weft_real)0.5, y = place.y - (weft_real)0.5;
    weft_real radius = fmax(fabs(x), fabs(y)), least = fmin(fabs(x), fabs(y));
    weft_real angle = radius > 0 ? (weft_real)(WEFT_PI / 4) * least / radius : 0;
    weft_real z = 1 - 4 * radius * radius, across = sqrt(fmax((weft_real)0, 1 - z * z));
    weft_real near = across * cos(angle), far = across * sin(angle);
    return (weft_vec3){copysign(fabs(x) >= fabs(y) ? near : far, x), copysign(fabs(x) >= fabs(y) ? far : near, y), z};
}

weft_square_cell weft_square_cell_at(weft_place place, int side)
{
    weft_real last = (weft_real)(side - 1);
    weft_real x = fmin(fmax(place.x, (weft_real)0), (weft_real)1) * last;
    weft_real y = fmin(fmax(place.y, (weft_real)0), (weft_real)1) * last;
    int i = (int)fmin(floor(x), last - 1), j = (int)fmin(floor(y), last - 1);
    weft_real s = x - (weft_real)i, t = y - (weft_real)j;
    int low = j * side + i, high = low + side;
    return (weft_square_cell){{low, low + 1, high, high + 1}, {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t}};
}
