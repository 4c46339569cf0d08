/* Particles in plain C that take part in a Calcine run through calcine_wire.h alone: the smallest member of the
 * contract for particles that docs/attach-a-solver.md walks through.
 *
 * Particles fly on their own: gas and gravity act on them, they touch neither each other nor a wall, and those of a
 * held population stay where they are. Over a window of span dt, with the force F of the gas,
 *
 *   v = v0 + (F/m + g) dt,   x = x0 + v0 dt + (F/m + g) dt^2 / 2,
 *
 * which is exact, as the force is constant over a window. Where a drag K (u - v) comes beside it (the columns of the
 * group moving_drag), the exact solution is, with k = K/m, a = k dt, and the velocity w = u + (F/m + g)/k that is
 * approached,
 *
 *   v = w + (v0 - w) exp(-a),   x = x0 + w dt + (v0 - w) (1 - exp(-a))/k,
 *
 * and the impulse of the drag is the change of momentum without that of F and gravity. A particle that leaves the box
 * from (0, 0, 0) to (width, depth, height) ends the run. Build and run:
 *
 *   cc -std=c11 -O2 -I adapters/wire/include ballistic_particles.c libcalcine_wire.a \
 *      -lgcc_s -lutil -lrt -lpthread -lm -ldl -o ballistic-particles
 *   calcine run case.toml --particles external  with `external.particles.program = "ballistic-particles"` in the case
 *
 * Its arguments, all in SI: width= depth= height= gravity= (along z). The particles lie in particles.csv where it
 * runs. */
#define _POSIX_C_SOURCE 200809L /* fsync, fileno */
#define SOLVER "ballistic-particles"
#include "solver.h"

#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <unistd.h>

#define PI 3.14159265358979323846

/* What the arguments say. */
static struct {
    double width, depth, height, gravity;
} given;

/* One particle; a checkpoint holds these as they are. */
typedef struct particle {
    uint64_t id, population, held;
    double position[3], velocity[3], spin[3];
    double impulse[3], drag_impulse[3]; /* of the last window, N s; that of drag is a part of the whole */
    double radius, mass, weight;
} particle;

static particle *all; /* in ascending id */
static uint64_t count;
static double acted; /* motion time of the last window, s */

static void resize(uint64_t to) {
    particle *made = realloc(all, (to ? to : 1) * sizeof *all);
    if (!made) fail(CALCINE_FAILURE_MEMORY, "no memory for %" PRIu64 " particles", to);
    all = made;
    count = to;
}

static double mass_of(double radius, double density) {
    return 4.0 / 3.0 * PI * radius * radius * radius * density;
}

/* The particle of an id. */
static particle *find(uint64_t id) {
    for (uint64_t p = 0; p < count; ++p)
        if (all[p].id == id) return &all[p];
    fail(CALCINE_FAILURE_INPUT, "there is no particle %" PRIu64, id);
}

/* Ids of particles that come are above all others: they go last. */
static particle *append(uint64_t id) {
    if (count > 0 && all[count - 1].id >= id)
        fail(CALCINE_FAILURE_INPUT, "particle %" PRIu64 " comes after particle %" PRIu64, id, all[count - 1].id);
    resize(count + 1);
    particle *new = &all[count - 1];
    memset(new, 0, sizeof *new);
    new->id = id;
    return new;
}

/* The particles of the case, below a line with the names of the columns. */
static void read_table(void) {
    FILE *file = fopen("particles.csv", "r");
    if (!file || fscanf(file, "%*[^\n]") == EOF) fail(CALCINE_FAILURE_FILE, "particles.csv cannot be read");
    uint64_t id, population, held;
    double x[3], v[3], radius, density, weight;
    while (fscanf(file, "%" SCNu64 ",%" SCNu64 ",%" SCNu64 ",%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &id, &population,
                  &held, &x[0], &x[1], &x[2], &v[0], &v[1], &v[2], &radius, &density, &weight) == 12) {
        particle *new = append(id);
        new->population = population;
        new->held = held;
        memcpy(new->position, x, sizeof x);
        memcpy(new->velocity, v, sizeof v);
        new->radius = radius;
        new->mass = mass_of(radius, density);
        new->weight = weight;
    }
    if (!feof(file)) fail(CALCINE_FAILURE_FILE, "particles.csv has no particle below particle %" PRIu64, count);
    fclose(file);
}

/* Reads or writes the particles. Their number comes first. */
static void checkpoint(const char *folder, int writes) {
    char path[4096];
    snprintf(path, sizeof path, "%s/ballistic_particles.state", folder);
    FILE *file = fopen(path, writes ? "wb" : "rb");
    if (!file) fail(CALCINE_FAILURE_FILE, "%s cannot be opened", path);
    uint64_t found = count;
    int done = (writes ? fwrite(&found, sizeof found, 1, file) : fread(&found, sizeof found, 1, file)) == 1;
    if (done && !writes) resize(found);
    done = done && (writes ? fwrite(all, sizeof *all, count, file) : fread(all, sizeof *all, count, file)) == count;
    if (!done || (writes && (fflush(file) != 0 || fsync(fileno(file)) != 0)))
        fail(CALCINE_FAILURE_FILE, "%s cannot be %s", path, writes ? "written" : "read");
    fclose(file);
}

/* Moves a free particle along one axis: `rate` is its acceleration without drag, k = K/m of drag towards u. */
static void move(particle *one, int axis, double rate, double k, double u) {
    double *x = &one->position[axis], *v = &one->velocity[axis], before = *v;
    if (k * acted > 0) {
        double slip = u + rate / k - before, relaxed = -expm1(-k * acted); /* 1 - exp(-a) */
        *x += (before + slip) * acted - slip * relaxed / k;
        *v += slip * relaxed;
        one->drag_impulse[axis] = one->mass * (slip * relaxed - rate * acted);
    } else {
        *x += before * acted + 0.5 * rate * acted * acted;
        *v += rate * acted;
    }
}

/* The window. Particles have one attempt: what is finished is the start of the next. */
static void advance(const calcine_header *header) {
    const uint64_t *ids = (const uint64_t *)(const void *)column("id", count);
    const double *force = column("force", 3 * count), *drag = column("drag_coefficient", count);
    const double *gas = column("gas_velocity", 3 * count);
    acted = TICK * (double)header->span_motion;
    for (uint64_t p = 0; p < count; ++p) {
        particle *one = &all[p];
        if (ids[p] != one->id)
            fail(CALCINE_FAILURE_INPUT, "a force for particle %" PRIu64 " in place of particle %" PRIu64, ids[p],
                 one->id);
        for (int axis = 0; axis < 3; ++axis) {
            double rate = force[3 * p + axis] / one->mass + (axis == 2 ? given.gravity : 0);
            one->drag_impulse[axis] = drag[p] * gas[3 * p + axis] * acted; /* of one that is held: its support takes it */
            if (!one->held) {
                one->drag_impulse[axis] = 0;
                move(one, axis, rate, drag[p] / one->mass, gas[3 * p + axis]);
            }
            one->impulse[axis] = force[3 * p + axis] * acted + one->drag_impulse[axis];
        }
        const double *x = one->position;
        if (!(isfinite(x[0] + x[1] + x[2])))
            fail(CALCINE_FAILURE_NOT_FINITE, "the position of particle %" PRIu64 " is not finite", one->id);
        if (x[0] < 0 || x[0] > given.width || x[1] < 0 || x[1] > given.depth || x[2] < 0 || x[2] > given.height)
            fail(CALCINE_FAILURE_LOST_PARTICLES, "particle %" PRIu64 " is at (%g, %g, %g) m, outside the box", one->id,
                 x[0], x[1], x[2]);
    }
}

/* Sends the state. Between windows nothing has acted. */
static void answer(calcine_kind kind) {
    int finished = kind == CALCINE_FINISHED;
    struct { const char *name; size_t offset, components; } columns[] = {
        {"id", offsetof(particle, id), 1}, {"population", offsetof(particle, population), 1},
        {"position", offsetof(particle, position), 3}, {"velocity", offsetof(particle, velocity), 3},
        {"angular_velocity", offsetof(particle, spin), 3}, {"radius", offsetof(particle, radius), 1},
        {"mass", offsetof(particle, mass), 1}, {"weight", offsetof(particle, weight), 1},
        {"impulse", offsetof(particle, impulse), 3}, {"drag_impulse", offsetof(particle, drag_impulse), 3}};
    need(calcine_link_loan(wire, kind, count));
    double *values;
    uint64_t length;
    for (size_t k = 0; k < sizeof columns / sizeof *columns; ++k) {
        size_t bytes = 8 * columns[k].components;
        need(calcine_link_loaned_column(wire, columns[k].name, &values, &length));
        for (uint64_t p = 0; p < count; ++p)
            memcpy((char *)values + p * bytes, (const char *)&all[p] + columns[k].offset, bytes);
        if (!finished && strstr(columns[k].name, "impulse")) memset(values, 0, length * sizeof *values);
    }
    /* Neither walls nor held particles touch a free one. */
    need(calcine_link_loaned_column(wire, "support", &values, &length));
    memset(values, 0, length * sizeof *values);
    values[0] = finished ? acted : 0;
    need(calcine_link_send(wire));
}

/* A change of the particles between two windows, one a line. */
static void change(const char *text) {
    for (int length = 0; *text; text += length) {
        uint64_t id, type;
        double x[3], v[3], radius, last, weight;
        length = 0;
        if (strncmp(text, "rest\n", 5) == 0) {
            for (uint64_t p = 0; p < count; ++p) {
                memset(all[p].velocity, 0, sizeof all[p].velocity);
                memset(all[p].spin, 0, sizeof all[p].spin);
            }
            length = 5;
        } else if (sscanf(text, "remove %" SCNu64 "%n", &id, &length) == 1) {
            particle *gone = find(id);
            memmove(gone, gone + 1, (size_t)(all + count - gone - 1) * sizeof *all);
            resize(count - 1);
        } else if (sscanf(text, "resize %" SCNu64 " %lf %lf%n", &id, &radius, &last, &length) == 3) {
            particle *one = find(id);
            one->radius = radius;
            one->mass = last;
        } else if (sscanf(text, "insert %" SCNu64 " %" SCNu64 " %lf %lf %lf %lf %lf %lf %lf %lf %lf%n", &id, &type,
                          &x[0], &x[1], &x[2], &v[0], &v[1], &v[2], &radius, &last, &weight, &length) == 11) {
            particle *new = append(id); /* free: a held population gets no newcomers */
            new->population = type - 1;
            memcpy(new->position, x, sizeof x);
            memcpy(new->velocity, v, sizeof v);
            new->radius = radius;
            new->mass = mass_of(radius, last);
            new->weight = weight;
        }
        if (length == 0) fail(CALCINE_FAILURE_UNSUPPORTED, "`%.60s` is no change of particles", text);
        if (text[length] == '\n') ++length;
    }
}

static void set_up(int words, char **word) {
    argument known[] = {{"width=", &given.width}, {"depth=", &given.depth}, {"height=", &given.height},
                        {"gravity=", &given.gravity}};
    read_arguments(words, word, known, sizeof known / sizeof *known);
    if (!(given.width > 0 && given.depth > 0 && given.height > 0))
        fail(CALCINE_FAILURE_INPUT, "width, depth and height must be positive");
}

int main(int words, char **word) {
    need(calcine_link_open(0, NULL, &wire));
    set_up(words, word);
    const char *resumed = getenv("CALCINE_RESUME");
    if (resumed) checkpoint(resumed, 0);
    else read_table();
    calcine_hello hello = {.role = "particles", .name = "ballistic particles", .version = "1", .origin = resumed,
                           .catalogue = "standard\nweights\nmoving_drag", .count = count, .ranks = 1};
    need(calcine_link_handshake(wire, &hello, 10000));
    answer(CALCINE_STATE);
    for (;;) {
        calcine_header header;
        const char *text;
        calcine_status status = calcine_link_receive(wire, 1000, &header, NULL, NULL);
        if (status == CALCINE_TIMEOUT) continue;
        need(status);
        switch (header.kind) {
        case CALCINE_START:
            advance(&header);
            answer(CALCINE_FINISHED);
            break;
        case CALCINE_COMMIT:
            break;
        case CALCINE_CHECKPOINT:
            need(calcine_link_text(wire, &text));
            checkpoint(text, 1);
            checkpoint(text, 0);
            answer(CALCINE_CHECKPOINTED);
            break;
        case CALCINE_CHANGE:
            need(calcine_link_text(wire, &text));
            change(text);
            answer(CALCINE_CHANGED);
            break;
        case CALCINE_BYE:
            need(calcine_link_loan(wire, CALCINE_BYE, 0));
            need(calcine_link_send(wire));
            calcine_link_close(wire);
            return 0;
        default:
            fail(CALCINE_FAILURE_UNSUPPORTED, "a request of kind %u is not for particles", header.kind);
        }
    }
}
