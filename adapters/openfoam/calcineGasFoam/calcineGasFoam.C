// calcineGasFoam: the gas of a coupled run, as Calcine's coordinator asks for it.
//
// Started by Calcine in a case folder, under mpirun with -parallel on several ranks, each of which has
// a link of its own; -resume DIR takes up the state that a checkpoint left in DIR, -from
// DIR starts a run of its own from it.
// Ends with 0 when asked to, with 1 after telling the coordinator what failed, and with 2 where there
// is no coordinator any more.
#include "gas.H"
#include "link.H"
#include "meshIdentity.H"
#include "process.H"
#include "windowLog.H"

#include "argList.H"
#include "fvMesh.H"
#include "IOdictionary.H"
#include "sigFpe.H"
#include "stringList.H"
#include "SolverPerformance.H"
#include "Time.H"

#include <sstream>

namespace
{

using namespace Foam;

// Ticks of the coordinator's clocks in a second.
const scalar ticksPerSecond = 1e12;

scalar seconds(int64_t ticks)
{
    return scalar(ticks)/ticksPerSecond;
}

calcine::window windowOf(const calcine_header& header)
{
    calcine::window when;
    when.index = header.window;
    when.number = header.attempt;
    when.motionSpan = seconds(header.span_motion);
    when.storageSpan = seconds(header.storage_span);
    when.processEnd = seconds(header.start_process) + seconds(header.span_process);
    if (!(when.motionSpan > 0 && when.storageSpan > 0))
    {
        FatalErrorInFunction
            << "a window with a motion span of " << when.motionSpan << " s and a storage span of "
            << when.storageSpan << " s; both must be positive" << exit(FatalError);
    }
    return when;
}

// What a link may have columns for.
struct optionalColumns
{
    // How the equations of turbulence were solved, in answer to a commit.
    bool answersCommits = false;
    // What particles make of eddies.
    bool bedEddies = false;
};

// A column of species by species within each cell.
void receiveSpecies(const calcine::link& link, const char* name, List<scalarField>& fields)
{
    scalarField flat(fields.size()*fields[0].size());
    link.get(name, flat);
    forAll(fields, k)
    {
        forAll(fields[k], celli)
        {
            fields[k][celli] = flat[celli*fields.size() + k];
            if (!(mag(fields[k][celli]) < GREAT))
            {
                throw calcine::solverFailure
                (
                    CALCINE_FAILURE_INPUT, std::string("the column ") + name + " holds a value that is not finite"
                );
            }
        }
    }
}

void receive
(
    const calcine::link& link,
    const calcine::addressing& numbers,
    calcine::exchange& given
)
{
    link.get("void_fraction", given.voidFraction);
    link.get("drag_coefficient", given.dragCoefficient);
    link.get("drag_source", given.dragSource);
    link.get("heat_coefficient", given.heatCoefficient);
    link.get("heat_source", given.heatSource);
    if (given.speciesSource.size())
    {
        receiveSpecies(link, "species_source", given.speciesSource);
        receiveSpecies(link, "species_coefficient", given.speciesCoefficient);
        receiveSpecies(link, "species_taken", given.speciesTaken);
        link.get("species_heat", given.speciesHeat);
    }
    if (given.eddyEnergy.size())
    {
        link.get("eddy_energy", given.eddyEnergy);
        link.get("eddy_dissipation", given.eddyDissipation);
        link.get("eddy_growth", given.eddyGrowth);
        forAll(given.eddyEnergy, celli)
        {
            const scalar energy = given.eddyEnergy[celli];
            const scalar dissipation = given.eddyDissipation[celli];
            const scalar growth = given.eddyGrowth[celli];
            const bool allowed = energy >= 0 && energy < GREAT && dissipation >= 0
             && dissipation < GREAT && growth >= 0 && growth < GREAT;
            if (!allowed)
            {
                OStringStream text;
                text<< "in cell " << numbers.cells[celli] << ": eddies of the bed of " << energy << " m2/s3, "
                    << dissipation << " m2/s4, " << growth << " 1/s (must be finite and not negative)";
                throw calcine::solverFailure(CALCINE_FAILURE_INPUT, text.str());
            }
        }
    }
    forAll(given.voidFraction, celli)
    {
        const scalar pores = given.voidFraction[celli];
        const bool allowed = pores > 0 && pores <= 1
         && given.dragCoefficient[celli] >= 0 && given.dragCoefficient[celli] < GREAT
         && given.heatCoefficient[celli] >= 0 && given.heatCoefficient[celli] < GREAT
         && mag(given.heatSource[celli]) < GREAT && mag(given.dragSource[celli]) < GREAT;
        if (!allowed)
        {
            OStringStream text;
            text<< "in cell " << numbers.cells[celli] << ": void fraction " << pores << " (must be in (0, 1]), "
                << given.dragCoefficient[celli] << " kg/s, " << given.dragSource[celli] << " N, "
                << given.heatCoefficient[celli] << " W/K, " << given.heatSource[celli]
                << " W (coefficients must be finite and not negative)";
            throw calcine::solverFailure(CALCINE_FAILURE_INPUT, text.str());
        }
    }
}

// Seven numbers of each balance, in the order of the catalogue.
void append(DynamicList<scalar>& list, const calcine::balance& b)
{
    for
    (
        const scalar value :
        {
            b.stored, b.storedMagnitude, b.boundary, b.boundaryMagnitude, b.exchange,
            b.source, b.sourceMagnitude
        }
    )
    {
        list.append(value);
    }
}

void send
(
    calcine::link& link,
    calcine_kind kind,
    const calcine::gas& gas,
    const calcine::report& result
)
{
    link.loan(kind, gas.temperature().size());
    link.put("heat", result.heat);
    link.put("drag", result.drag);
    link.put("temperature", gas.temperature());
    link.put("pressure", gas.absolutePressure());
    link.put("density", gas.gasDensity());
    link.put("velocity", gas.velocity());
    link.put("pressure_gradient", gas.pressureGradient());
    if (gas.speciesNames().size())
    {
        link.put("composition", gas.composition());
    }
    if (gas.sendsEddies())
    {
        link.put("turbulent_energy", gas.eddies().energy());
        link.put("dissipation", gas.eddies().dissipation());
        link.put("eddy_viscosity", gas.eddies().viscosity());
    }
    if (gas.tellsBackflow())
    {
        link.put("backflow", gas.backflow());
    }
    DynamicList<scalar> balances(35 + 7*gas.speciesNames().size());
    append(balances, result.mass);
    append(balances, result.energy);
    for (const calcine::balance& component : result.momentum)
    {
        append(balances, component);
    }
    for (const calcine::balance& species : result.species)
    {
        append(balances, species);
    }
    link.put("balances", balances);
    if (gas.patches())
    {
        DynamicList<scalar> flows;
        for (const scalarList& flow : result.patches)
        {
            flows.append(flow);
        }
        link.put("patch_flows", flows);
    }
    const vector& clock = result.storageClock;
    link.put("storage_clock", scalarList{clock.x(), clock.y(), clock.z()});
    const scalarList convergence
    {
        scalar(result.outerIterations), scalar(result.linearIterations), result.residual,
        result.volumeResidual, scalar(result.converged)
    };
    link.put("convergence", convergence);
    link.send();
}

// Nothing received, nothing solved: what goes with a state.
calcine::report emptyReport(label cells, label species, label patches)
{
    calcine::report empty;
    empty.species.setSize(species);
    empty.patches.setSize(patches, scalarList(5 + species, Zero));
    empty.heat.setSize(cells, 0);
    empty.drag.setSize(cells, Zero);
    return empty;
}

void serve
(
    calcine::link& link,
    calcine::gas& gas,
    const calcine::addressing& numbers,
    calcine::windowLog& log,
    const optionalColumns& columns
)
{
    const label cells = numbers.cells.size();
    calcine::exchange given;
    given.voidFraction.setSize(cells);
    given.dragCoefficient.setSize(cells);
    given.dragSource.setSize(cells);
    given.heatCoefficient.setSize(cells);
    given.heatSource.setSize(cells);
    const label species = gas.speciesNames().size();
    for (auto* list : {&given.speciesSource, &given.speciesCoefficient, &given.speciesTaken})
    {
        list->setSize(species);
        for (scalarField& one : *list)
        {
            one.setSize(cells);
        }
    }
    given.speciesHeat.setSize(species ? cells : 0);
    for (scalarField* list : {&given.eddyEnergy, &given.eddyDissipation, &given.eddyGrowth})
    {
        list->setSize(columns.bedEddies ? cells : 0);
    }
    calcine::report result;

    for (;;)
    {
        const calcine_header header = link.receive();
        switch (header.kind)
        {
            case CALCINE_START:
            {
                const calcine::window when = windowOf(header);
                receive(link, numbers, given);
                gas.attempt(when, given, result);
                log.tell(when, result);
                send(link, CALCINE_FINISHED, gas, result);
                break;
            }
            case CALCINE_COMMIT:
                gas.commit();
                if (columns.answersCommits)
                {
                    link.loan(CALCINE_COMMITTED, 0);
                    link.put("turbulence_residual", scalarList{gas.eddies().unsolved()});
                    link.send();
                }
                break;
            case CALCINE_CHECKPOINT:
                gas.checkpoint(link.text());
                send(link, CALCINE_CHECKPOINTED, gas, emptyReport(cells, species, gas.patches()));
                break;
            case CALCINE_BOUNDARY:
                gas.setBoundary(link.text());
                link.loan(CALCINE_BOUNDARY, 0);
                link.send();
                break;
            case CALCINE_BYE:
                link.loan(CALCINE_BYE, 0);
                link.send();
                return;
            default:
                throw calcine::solverFailure
                (
                    CALCINE_FAILURE_UNSUPPORTED,
                    "a request of kind " + std::to_string(header.kind) + " arrived, which a gas does not serve"
                );
        }
    }
}

// What fvSolution and fvSchemes ask for, and this solver does not do, is refused by name.
void refuseUnused(const fvMesh& mesh)
{
    const dictionary& solution = mesh.solutionDict();
    for (const char* algorithm : {"PIMPLE", "PISO", "SIMPLE"})
    {
        if (solution.isDict(algorithm))
        {
            FatalIOErrorInFunction(solution)
                << "`" << algorithm << "` has no effect in calcineGasFoam: remove it, and state outer_iterations, "
                << "pressure_corrections and outer_tolerance in `gas.controls` of the case" << exit(FatalIOError);
        }
    }
    if (solution.isDict("relaxationFactors") && !solution.subDict("relaxationFactors").empty())
    {
        FatalIOErrorInFunction(solution)
            << "`relaxationFactors` have no effect in calcineGasFoam: remove them" << exit(FatalIOError);
    }
    const dictionary& schemes = mesh.schemesDict();
    if (schemes.isDict("ddtSchemes"))
    {
        const dictionary& times = schemes.subDict("ddtSchemes");
        for (const char* name : {"default", "ddt(U)", "ddt(rho,U)", "ddt(h)", "ddt(rho,h)"})
        {
            const word scheme(times.found(name) ? word(times.lookup(name)) : word("Euler"));
            if (scheme != "Euler" && scheme != "steadyState" && scheme != "none")
            {
                FatalIOErrorInFunction(times)
                    << "`" << name << " " << scheme << "` of ddtSchemes has no effect in calcineGasFoam, which steps in time itself: "
                    << "remove it, and state `gas.controls.time_scheme` in the case" << exit(FatalIOError);
            }
        }
    }
}

void run(const argList& args, calcine::link& link)
{
    Time runTime(Time::controlDictName, args);
    // Numbers that overflow are found after each outer iteration and told with their cell; a signal
    // would tell neither.
    sigFpe::unset(false);
    SolverPerformance<scalar>::debug = 0;
    SolverPerformance<vector>::debug = 0;

    fvMesh mesh
    (
        IOobject(fvMesh::defaultRegion, runTime.timeName(), runTime, IOobject::MUST_READ)
    );
    refuseUnused(mesh);
    const calcine::addressing numbers(mesh);
    calcine::compareCells(mesh, numbers);
    const IOdictionary properties
    (
        IOobject("calcineGas", runTime.constant(), mesh, IOobject::MUST_READ)
    );
    calcine::gas gas(mesh, properties, numbers);
    calcine::introduction own(calcine::introduce(properties, mesh, numbers));
    if (args.found("resume"))
    {
        own.origin = args.opt<fileName>("resume");
        gas.resume(own.origin);
    }
    else if (args.found("from"))
    {
        own.origin = args.opt<fileName>("from");
        gas.takeOver(own.origin);
    }

    optionalColumns columns;
    for (const string& column : properties.get<stringList>("catalogue"))
    {
        columns.answersCommits = columns.answersCommits || column.compare(0, 10, "committed ") == 0;
        columns.bedEddies = columns.bedEddies || column.compare(0, 18, "start eddy_energy ") == 0;
    }
    link.greet(own);
    link.claim(numbers.cells);
    send(link, CALCINE_STATE, gas, emptyReport(mesh.nCells(), gas.speciesNames().size(), gas.patches()));
    calcine::windowLog log(properties.lookupOrDefault<scalar>("logInterval", 1));
    serve(link, gas, numbers, log, columns);
    Info<< "End" << endl;
}

} // End anonymous namespace


int main(int argc, char* argv[])
{
    argList::noFunctionObjects();
    argList::addOption("resume", "dir", "take up the state of a checkpoint in this folder");
    argList::addOption("from", "dir", "start from the fields of another run's checkpoint");
    argList args(argc, argv);
    return calcine::process("calcineGasFoam", [&args](calcine::link& link) { run(args, link); });
}
