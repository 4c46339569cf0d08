/* A gas solver in plain C that takes part in a Calcine run through calcine_wire.h alone: the smallest member of
 * the contract that docs/attach-a-solver.md walks through.
 *
 * Air, an ideal gas at the pressure of its outlet, rises or sinks through a column of N cells along z. One
 * attempt advances, implicitly in the exchange with the particles,
 *
 *   mass      m - m0 = Dt (F_below - F_above),                     m = eps rho(T) V
 *   enthalpy  m h - m0 h0 = Dt (F h by upwind + S - K T),          h = c_p (T - 298.15 K)
 *   momentum  m0 (u - u0)/dt + inflow (u - u_upwind) = -eps V dp/dz + eps rho g V + S_z - D u
 *
 * with Dt the storage span (process clock) and dt the motion span. Continuity gives the mass flows F, the
 * enthalpy equation h, the momentum equation the pressure gradient. Gas does not conduct and has no friction
 * at walls. Build and run:
 *
 *   cc -std=c11 -O2 -I adapters/wire/include column_gas.c libcalcine_wire.a \
 *      -lgcc_s -lutil -lrt -lpthread -lm -ldl -o column-gas
 *   calcine run case.toml --gas external        with `external.gas.program = "column-gas"` in the case
 *
 * Its arguments, all in SI: width= depth= height= cells= velocity= inlet_temperature= temperature= pressure=
 * gravity= (along z). */
#define _POSIX_C_SOURCE 200809L /* fsync, fileno */
#define SOLVER "column-gas"
#include "solver.h"

#include <math.h>
#include <unistd.h>

#define GAS_CONSTANT (8.314462618 / 28.96e-3) /* of air, J/kg/K */
#define HEAT_CAPACITY 1007.0            /* of air, J/kg/K */
#define REFERENCE 298.15                /* K, where enthalpies are zero */
#define TOLERANCE 4e-15                 /* change of a mass flow at which the iteration ends, of the largest term */
#define ITERATIONS 100

/* What the arguments say. */
static struct {
    double width, depth, height, cells, velocity, inlet_temperature, temperature, pressure, gravity;
} given = {0, 0, 0, 0, 0, 300, 300, 101325, 0};

/* Values of each cell at one time, and the mass flows through the N + 1 faces across z, upwards, in kg/s. The
 * gradient is that of pressure along z in Pa/m. */
typedef struct state {
    double *mass, *enthalpy, *velocity, *gradient, *flow;
} state;

static uint64_t cells;
static double area, volume, height;          /* of a cell, SI */
static state committed, now;
static int has_started;                      /* a window has been committed */
static double *void_fraction;
static double *heat, *drag;                  /* taken from the particles in the last attempt, W and N */
static double balances[5][7];                /* mass, energy, momentum x, y, z: see calcine_wire.h */
static double storage_clock;                 /* N s */
static double convergence[5];

static double *list(uint64_t count) {
    double *made = calloc(count, sizeof *made);
    if (!made) fail(CALCINE_FAILURE_MEMORY, "no memory for %llu numbers", (unsigned long long)count);
    return made;
}

static state make_state(void) {
    state made = {list(cells), list(cells), list(cells), list(cells), list(cells + 1)};
    return made;
}

static void copy(state *to, const state *from) {
    memcpy(to->mass, from->mass, cells * sizeof(double));
    memcpy(to->enthalpy, from->enthalpy, cells * sizeof(double));
    memcpy(to->velocity, from->velocity, cells * sizeof(double));
    memcpy(to->gradient, from->gradient, cells * sizeof(double));
    memcpy(to->flow, from->flow, (cells + 1) * sizeof(double));
}

static double enthalpy_of(double temperature) {
    return HEAT_CAPACITY * (temperature - REFERENCE);
}

static double temperature_of(double enthalpy) {
    return REFERENCE + enthalpy / HEAT_CAPACITY;
}

static double density(double enthalpy) {
    return given.pressure / (GAS_CONSTANT * temperature_of(enthalpy));
}

/* ------------------------------------------------------------------ the window ---- */

/* What an attempt is told, one value a cell. */
typedef struct exchange {
    const double *drag_coefficient, *drag_source, *heat_coefficient, *heat_source;
} exchange;

/* Until a window is committed the pores of the bed that comes with an attempt hold the gas of the start. */
static void fill_pores(void) {
    for (uint64_t c = 0; c < cells; ++c) {
        committed.mass[c] = void_fraction[c] * density(committed.enthalpy[c]) * volume;
        committed.velocity[c] = given.velocity / void_fraction[c];
    }
    for (uint64_t f = 0; f <= cells; ++f)
        committed.flow[f] = density(enthalpy_of(given.temperature)) * given.velocity * area;
}

/* Enthalpies at the mass flows at hand: a tridiagonal system (Thomas' algorithm). Continuity is subtracted, so that
 * m0 and inflows alone stand in it; gas that enters at the top has the enthalpy of the last cell. */
static void solve_enthalpies(const exchange *told, double span) {
    static double *upper;
    if (!upper) upper = list(cells);
    for (uint64_t c = 0; c < cells; ++c) {
        double below = fmax(now.flow[c], 0), above = c + 1 < cells ? fmax(-now.flow[c + 1], 0) : 0;
        double inertia = committed.mass[c] / span;
        double diagonal = inertia + below + above + told->heat_coefficient[c] / HEAT_CAPACITY;
        double right = inertia * committed.enthalpy[c] + told->heat_source[c] - told->heat_coefficient[c] * REFERENCE;
        if (c == 0) {
            right += below * enthalpy_of(given.inlet_temperature);
        } else {
            diagonal -= below * upper[c - 1];
            right += below * now.enthalpy[c - 1];
        }
        upper[c] = above / diagonal;
        now.enthalpy[c] = right / diagonal;
    }
    for (uint64_t c = cells - 1; c-- > 0;) now.enthalpy[c] += upper[c] * now.enthalpy[c + 1];
}

/* Masses of the enthalpies at hand and the flows that they leave; the largest change of a flow, relative to the
 * largest term of continuity. */
static double follow_continuity(double span) {
    double change = 0, largest = 0;
    for (uint64_t f = 0; f <= cells; ++f) {
        double flow = density(enthalpy_of(given.inlet_temperature)) * given.velocity * area;
        if (f > 0) {
            uint64_t c = f - 1;
            now.mass[c] = void_fraction[c] * density(now.enthalpy[c]) * volume;
            flow = now.flow[c] - (now.mass[c] - committed.mass[c]) / span;
            largest = fmax(largest, now.mass[c] / span);
        }
        change = fmax(change, fabs(flow - now.flow[f]));
        largest = fmax(largest, fabs(flow));
        now.flow[f] = flow;
    }
    return change / largest;
}

/* What of a quantity of the gas below and above a face passes it upwards; above the last face lies its own. */
static double carried(uint64_t face, const double *values, double at_inlet) {
    double flow = now.flow[face];
    double below = face == 0 ? at_inlet : values[face - 1];
    double above = face == cells ? values[cells - 1] : values[face];
    return flow * (flow > 0 ? below : above);
}

static void add(double *balance, int term, double value) {
    balance[term] += value;
    if (term != 4) balance[term + 1] += fabs(value); /* each but the exchange has its magnitude after it */
}

enum { STORED = 0, BOUNDARY = 2, EXCHANGE = 4, SOURCE = 5 };

/* Velocities, drag, the pressure gradient that the momentum equation asks for, and the balances. */
static void take_stock(const exchange *told, double motion, double span) {
    memset(balances, 0, sizeof balances);
    storage_clock = 0;
    for (uint64_t c = 0; c < cells; ++c)
        now.velocity[c] = 0.5 * (now.flow[c] + now.flow[c + 1])
            / (void_fraction[c] * density(now.enthalpy[c]) * area);
    double inlet = given.velocity / void_fraction[0];
    for (uint64_t c = 0; c < cells; ++c) {
        double u = now.velocity[c], gained = now.mass[c] - committed.mass[c];
        double below = fmax(now.flow[c], 0) * (u - (c > 0 ? now.velocity[c - 1] : inlet));
        double above = c + 1 < cells ? fmax(-now.flow[c + 1], 0) * (u - now.velocity[c + 1]) : 0;
        double rho = density(now.enthalpy[c]), pores = void_fraction[c] * volume;
        /* Across the column the gas is at rest, and walls take up what drag there is. */
        drag[3 * c] = told->drag_source[3 * c];
        drag[3 * c + 1] = told->drag_source[3 * c + 1];
        drag[3 * c + 2] = told->drag_source[3 * c + 2] - told->drag_coefficient[c] * u;
        double push = committed.mass[c] * (u - committed.velocity[c]) / motion + below + above - drag[3 * c + 2];
        now.gradient[c] = rho * given.gravity - push / pores;
        heat[c] = told->heat_source[c] - told->heat_coefficient[c] * temperature_of(now.enthalpy[c]);

        add(balances[0], STORED, gained);
        add(balances[1], STORED, now.mass[c] * now.enthalpy[c] - committed.mass[c] * committed.enthalpy[c]);
        add(balances[1], EXCHANGE, span * heat[c]);
        add(balances[4], STORED, now.mass[c] * u - committed.mass[c] * committed.velocity[c]);
        /* Pressure and weight, and u times the residual of continuity on the motion clock. */
        double residual = gained + motion * (now.flow[c + 1] - now.flow[c]);
        add(balances[4], SOURCE, motion * push + residual * u);
        for (int axis = 0; axis < 3; ++axis) add(balances[2 + axis], EXCHANGE, motion * drag[3 * c + axis]);
        for (int axis = 0; axis < 2; ++axis) add(balances[2 + axis], SOURCE, -motion * drag[3 * c + axis]);
        storage_clock += (1 - motion / span) * gained * u;
    }
    uint64_t ends[2] = {0, cells};
    for (int end = 0; end < 2; ++end) {
        double into = end == 0 ? 1 : -1;
        add(balances[0], BOUNDARY, into * span * now.flow[ends[end]]);
        add(balances[1], BOUNDARY,
            into * span * carried(ends[end], now.enthalpy, enthalpy_of(given.inlet_temperature)));
        add(balances[4], BOUNDARY, into * motion * carried(ends[end], now.velocity, inlet));
    }
}

/* One attempt, always from what is committed. */
static void attempt(const calcine_header *header) {
    double motion = TICK * (double)header->span_motion, span = TICK * (double)header->storage_span;
    const double *pores = column("void_fraction", cells);
    exchange told = {column("drag_coefficient", cells), column("drag_source", 3 * cells),
                     column("heat_coefficient", cells), column("heat_source", cells)};
    for (uint64_t c = 0; c < cells; ++c) {
        if (!(pores[c] > 0 && pores[c] <= 1))
            fail(CALCINE_FAILURE_INPUT, "a void fraction of %g in cell %llu", pores[c], (unsigned long long)c);
        if (!(told.heat_coefficient[c] >= 0) || !isfinite(told.heat_source[c]))
            fail(CALCINE_FAILURE_INPUT, "a heat of %g W less %g W/K in cell %llu", told.heat_source[c],
                 told.heat_coefficient[c], (unsigned long long)c);
    }
    memcpy(void_fraction, pores, cells * sizeof *pores);
    if (!has_started) fill_pores();
    copy(&now, &committed);
    int iteration = 0;
    double change = INFINITY;
    while (change > TOLERANCE && iteration < ITERATIONS) {
        solve_enthalpies(&told, span);
        change = follow_continuity(span);
        ++iteration;
    }
    for (uint64_t c = 0; c < cells; ++c) {
        double z = ((double)c + 0.5) * height, temperature = temperature_of(now.enthalpy[c]);
        if (!isfinite(temperature + now.flow[c + 1]))
            fail(CALCINE_FAILURE_NOT_FINITE, "temperature or mass flow is not finite in cell %llu at z = %g m",
                 (unsigned long long)c, z);
        if (!(temperature > 0))
            fail(CALCINE_FAILURE_DIVERGED, "temperature of %g K in cell %llu at z = %g m", temperature,
                 (unsigned long long)c, z);
    }
    take_stock(&told, motion, span);
    double report[5] = {iteration, 0, change, 0, change <= TOLERANCE};
    memcpy(convergence, report, sizeof convergence);
}

/* ----------------------------------------------------------------- the messages ---- */

static double *loaned(const char *name) {
    double *values;
    uint64_t length;
    need(calcine_link_loaned_column(wire, name, &values, &length));
    return values;
}

/* The state of the gas, with what the last attempt took; a state between windows has taken nothing. */
static void answer(calcine_kind kind) {
    int finished = kind == CALCINE_FINISHED;
    need(calcine_link_loan(wire, kind, cells));
    double *temperature = loaned("temperature"), *rho = loaned("density"), *velocity = loaned("velocity");
    double *pressure = loaned("pressure"), *slope = loaned("pressure_gradient");
    for (uint64_t c = cells; c-- > 0;) {
        temperature[c] = temperature_of(now.enthalpy[c]);
        rho[c] = density(now.enthalpy[c]);
        pressure[c] = (c + 1 < cells ? pressure[c + 1] - 0.5 * height * now.gradient[c + 1] : given.pressure)
            - 0.5 * height * now.gradient[c];
        for (int axis = 0; axis < 3; ++axis) {
            velocity[3 * c + axis] = axis == 2 ? now.velocity[c] : 0;
            slope[3 * c + axis] = axis == 2 ? now.gradient[c] : 0;
        }
    }
    struct { const char *name; const double *values; size_t count; } taken[] = {
        {"heat", heat, cells}, {"drag", drag, 3 * cells}, {"balances", balances[0], 35},
        {"convergence", convergence, 5}, {"storage_clock", NULL, 3}};
    for (size_t k = 0; k < sizeof taken / sizeof *taken; ++k) {
        double *values = loaned(taken[k].name);
        memset(values, 0, taken[k].count * sizeof *values);
        if (finished && taken[k].values) memcpy(values, taken[k].values, taken[k].count * sizeof *values);
        if (finished && !taken[k].values) values[2] = storage_clock;
    }
    need(calcine_link_send(wire));
}

/* Which cells of the whole mesh this rank has, all of them here, and where they lie: the coordinator compares. */
static void claim_cells(void) {
    need(calcine_link_loan(wire, CALCINE_OWNED, cells));
    uint64_t *numbers = (uint64_t *)(void *)loaned("cell");
    double *centres = loaned("centre"), *volumes = loaned("volume");
    for (uint64_t c = 0; c < cells; ++c) {
        numbers[c] = c;
        centres[3 * c] = 0.5 * given.width;
        centres[3 * c + 1] = 0.5 * given.depth;
        centres[3 * c + 2] = (c + 0.5) * height;
        volumes[c] = volume;
    }
    need(calcine_link_send(wire));
}

/* Reads or writes what is committed. The number of cells comes first, then whether a window was committed. */
static void checkpoint(const char *folder, int writes) {
    char path[4096];
    snprintf(path, sizeof path, "%s/column_gas.state", folder);
    FILE *file = fopen(path, writes ? "wb" : "rb");
    if (!file) fail(CALCINE_FAILURE_FILE, "%s cannot be opened", path);
    double head[2] = {(double)cells, has_started};
    struct { double *values; size_t count; } parts[] = {
        {head, 2}, {committed.mass, cells}, {committed.enthalpy, cells}, {committed.velocity, cells},
        {committed.gradient, cells}, {committed.flow, cells + 1}};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; ++k) {
        size_t done = writes ? fwrite(parts[k].values, sizeof(double), parts[k].count, file)
                             : fread(parts[k].values, sizeof(double), parts[k].count, file);
        if (done != parts[k].count || head[0] != (double)cells)
            fail(CALCINE_FAILURE_FILE, "%s is not the state of %llu cells", path, (unsigned long long)cells);
    }
    if (writes && (fflush(file) != 0 || fsync(fileno(file)) != 0))
        fail(CALCINE_FAILURE_FILE, "%s cannot be written", path);
    fclose(file);
    has_started = head[1] != 0;
    copy(&now, &committed);
}

/* Conditions that are set while the run goes on, one a line: patch, condition, value. */
static void set_conditions(const char *text) {
    char patch[64], condition[64];
    double value;
    int length;
    while (sscanf(text, " %63s %63s %lf%n", patch, condition, &value, &length) == 3) {
        double *place = strcmp(patch, "bottom") == 0 && strcmp(condition, "superficial_velocity") == 0
            ? &given.velocity
            : strcmp(patch, "bottom") == 0 && strcmp(condition, "temperature") == 0 ? &given.inlet_temperature
            : strcmp(patch, "top") == 0 && strcmp(condition, "pressure") == 0 ? &given.pressure : NULL;
        if (!place) fail(CALCINE_FAILURE_UNSUPPORTED, "%s of the patch %s cannot be set", condition, patch);
        *place = value;
        text += length;
    }
}

static void set_up(int count, char **words) {
    argument known[] = {
        {"width=", &given.width}, {"depth=", &given.depth}, {"height=", &given.height}, {"cells=", &given.cells},
        {"velocity=", &given.velocity}, {"inlet_temperature=", &given.inlet_temperature},
        {"temperature=", &given.temperature}, {"pressure=", &given.pressure}, {"gravity=", &given.gravity}};
    read_arguments(count, words, known, sizeof known / sizeof *known);
    if (!(given.width > 0 && given.depth > 0 && given.height > 0 && given.cells >= 1 && given.velocity >= 0
          && given.temperature > 0 && given.inlet_temperature > 0 && given.pressure > 0))
        fail(CALCINE_FAILURE_INPUT, "width, depth, height, cells, temperatures and pressure must be positive");
    cells = (uint64_t)given.cells;
    area = given.width * given.depth;
    height = given.height / given.cells;
    volume = area * height;
}

int main(int count, char **words) {
    need(calcine_link_open(0, NULL, &wire));
    set_up(count, words);
    committed = make_state();
    now = make_state();
    void_fraction = list(cells);
    heat = list(cells);
    drag = list(3 * cells);
    for (uint64_t c = 0; c < cells; ++c) {
        committed.enthalpy[c] = enthalpy_of(given.temperature);
        committed.velocity[c] = given.velocity; /* superficial: nothing is known of the bed yet */
    }
    copy(&now, &committed);
    const char *resumed = getenv("CALCINE_RESUME");
    if (resumed) checkpoint(resumed, 0);

    calcine_hello hello = {.role = "gas", .name = "column gas", .version = "1", .origin = resumed,
                           .count = cells, .ranks = 1};
    need(calcine_link_handshake(wire, &hello, 10000));
    claim_cells();
    answer(CALCINE_STATE);
    for (;;) {
        calcine_header header;
        const char *text;
        calcine_status status = calcine_link_receive(wire, 1000, &header, NULL, NULL);
        if (status == CALCINE_TIMEOUT) continue;
        need(status);
        switch (header.kind) {
        case CALCINE_START:
            attempt(&header);
            answer(CALCINE_FINISHED);
            break;
        case CALCINE_COMMIT:
            copy(&committed, &now);
            has_started = 1;
            break;
        case CALCINE_CHECKPOINT:
            need(calcine_link_text(wire, &text));
            checkpoint(text, 1);
            checkpoint(text, 0);
            answer(CALCINE_CHECKPOINTED);
            break;
        case CALCINE_BOUNDARY:
            need(calcine_link_text(wire, &text));
            set_conditions(text);
            need(calcine_link_loan(wire, CALCINE_BOUNDARY, 0));
            need(calcine_link_send(wire));
            break;
        case CALCINE_BYE:
            need(calcine_link_loan(wire, CALCINE_BYE, 0));
            need(calcine_link_send(wire));
            calcine_link_close(wire);
            return 0;
        default:
            fail(CALCINE_FAILURE_UNSUPPORTED, "a request of kind %u is not for a gas", header.kind);
        }
    }
}
