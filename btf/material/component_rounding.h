/* Coarser numbers in the components of a material (btf/material/components.h), where what is rounded away does not
 * matter: a file of fewer digits is smaller. The scale of a layer takes the steps, so that every reader plays the
 * result. */
#ifndef WEFT_BTF_MATERIAL_COMPONENT_ROUNDING_H
#define WEFT_BTF_MATERIAL_COMPONENT_ROUNDING_H

#include "btf/material/components.h"

/* Rounds the values of each layer to steps that change reflectance times cosine by `step` > 0, RMS over the texels of
 * the finest level; but no finer than a 2048th of the largest value: half floats hold no larger whole numbers
 * exactly. A component that no texel has any of gets values of 0. */
void weft_components_round_values(double step, weft_components *components);

/* Rounds the coefficients of each layer to steps that change reflectance times cosine by `step` > 0, RMS over the
 * images: on all levels, or where `halved` by half as much from level to level, down to between one and two steps of
 * the codes as they were. Steps that are finer than those of the codes change nothing. */
void weft_components_round_coefficients(double step, bool halved, weft_components *components);

/* Both, the values first; coefficients by half as much on every coarser level: more is averaged out there, so that what
 * is rounded away would show. */
void weft_components_round(double step, weft_components *components);

#endif
