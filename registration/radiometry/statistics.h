/* Small statistics of the report and the screen. Pure functions; they sort their input. */
#ifndef WEFT_REGISTRATION_RADIOMETRY_STATISTICS_H
#define WEFT_REGISTRATION_RADIOMETRY_STATISTICS_H

/* Sorts `value` and gives the quantile 0..1 of its `count` values (nearest rank); 0 for none. */
double weft_quantile(double *value, int count, double quantile);

#endif
