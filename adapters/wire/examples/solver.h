/* What both example solvers need around calcine_wire.h: their connection, errors, columns, arguments. SOLVER is the
 * name in messages. */
#ifndef SOLVER_H
#define SOLVER_H

#include "calcine_wire.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TICK 1e-12 /* s, unit of the clocks */

static calcine_link *wire;

/* Ends this process, after telling the coordinator why. */
_Noreturn static void fail(calcine_failure kind, const char *format, ...) {
    char text[512];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    fprintf(stderr, SOLVER ": %s\n", text);
    if (wire) calcine_link_failed(wire, kind, text);
    exit(1);
}

/* Every call of the wire but the wait for a request must succeed. */
static void need(calcine_status status) {
    if (status == CALCINE_OK) return;
    fprintf(stderr, SOLVER ": %s\n", calcine_last_error());
    exit(status == CALCINE_PEER_DEAD ? 2 : 1);
}

/* A column of the request, which must have so many numbers. */
static const double *column(const char *name, uint64_t expected) {
    const double *values;
    uint64_t length;
    need(calcine_link_column(wire, name, &values, &length));
    if (length != expected)
        fail(CALCINE_FAILURE_INPUT, "the column %s has %llu numbers, expected %llu", name, (unsigned long long)length,
             (unsigned long long)expected);
    return values;
}

/* An argument NAME=VALUE. */
typedef struct argument {
    const char *name; /* with the sign of equality */
    double *value;
} argument;

static void read_arguments(int words, char **word, const argument *known, size_t of) {
    for (int k = 1; k < words; ++k) {
        size_t found = 0;
        while (found < of && strncmp(word[k], known[found].name, strlen(known[found].name)) != 0) ++found;
        if (found == of) fail(CALCINE_FAILURE_INPUT, "`%s` is no argument", word[k]);
        char *end, *start = word[k] + strlen(known[found].name);
        *known[found].value = strtod(start, &end);
        if (*end || end == start) fail(CALCINE_FAILURE_INPUT, "`%s` has no number", word[k]);
    }
}

#endif
