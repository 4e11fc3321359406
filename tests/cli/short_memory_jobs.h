/* The command lines that test_short_memory runs, and what they read: the smallest that goes through each command. */
#ifndef WEFT_TESTS_CLI_SHORT_MEMORY_JOBS_H
#define WEFT_TESTS_CLI_SHORT_MEMORY_JOBS_H

enum { SHORT_MEMORY_ARGUMENTS = 24 };

typedef enum short_memory_way {
    ALL_OR_NOTHING, /* of the files that it writes */
    PRINTS,         /* its result goes to standard output */
    GOES_ON         /* what it has done when it fails is kept, and the same command goes on from there */
} short_memory_way;

typedef struct short_memory_job {
    const char *name;
    short_memory_way way;
    const char *argument[SHORT_MEMORY_ARGUMENTS]; /* after "weft" */
} short_memory_job;

/* Each ends with one whose name is NULL. Inputs stand in an order in which each reads only what those before have
 * written into the folder. Jobs run in a folder beside the inputs. */
extern const short_memory_job short_memory_inputs[], short_memory_jobs[];

/* Writes what no command writes into the current folder. A failure ends the program. */
void short_memory_write_inputs(void);

#endif
