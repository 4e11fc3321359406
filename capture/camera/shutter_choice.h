/* The words in which cameras name exposure times: "1/60", "0.5", "1.3s", "30". */
#ifndef WEFT_CAPTURE_CAMERA_SHUTTER_CHOICE_H
#define WEFT_CAPTURE_CAMERA_SHUTTER_CHOICE_H

/* Seconds; 0 for what is no time: "bulb", "Auto", "Unknown value 00f8". Pure, whatever the locale. */
double weft_shutter_seconds(const char *choice);

#endif
