/* What the user should know of the views and lamps that were found. */
#ifndef WEFT_REGISTRATION_HAND_NOTES_H
#define WEFT_REGISTRATION_HAND_NOTES_H

#include "registration/hand/hand.h"

/* Adds a line to the notes of `hand` where balls or pin contradict the paper, and where the tone curve leaves dark
 * cloth open. Errors: WEFT_SYSTEM for memory. */
weft_code weft_hand_note(weft_hand *hand, weft_error *error);

/* Refuses photographs that all show the cloth from one side under one light, within 3 degrees. Errors: WEFT_BAD_INPUT
 * naming the folder. Pure. */
weft_code weft_hand_check_variety(const char *folder, const weft_hand *hand, weft_error *error);

#endif
