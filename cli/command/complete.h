/* What the shells ask when a user presses Tab. */
#ifndef WEFT_CLI_COMPLETE_H
#define WEFT_CLI_COMPLETE_H

/* `weft --complete WORD...`: prints what the last word, which may be empty, may become after those before it. A line
 * holds a candidate, a tab and what it means. The line ":file" stands for the names of files, those that end with
 * what follows its tab; the line ":folder" for folders. The shell may cut "--name=value" into three words. Returns the
 * exit code, which is 0. */
int weft_complete(int count, char **word);

#endif
