// calcineParcelFoam: the parcels of a coupled run in OpenFOAM's MP-PIC cloud, as Calcine's coordinator asks for them.
//
// Started by Calcine in a case folder on one rank; -resume DIR takes up the parcels that a checkpoint left in DIR. Ends
// with 0 when asked to, with 1 after telling the coordinator what failed, and with 2 where there is no coordinator any
// more.
#include "link.H"
#include "meshIdentity.H"
#include "parcels.H"
#include "process.H"

#include "argList.H"
#include "fvMesh.H"
#include "IOdictionary.H"
#include "sigFpe.H"
#include "stringList.H"
#include "SolverPerformance.H"
#include "Time.H"

namespace
{

using namespace Foam;

// Ticks of the coordinator's clocks in a second.
const scalar ticksPerSecond = 1e12;

// Columns that a link may have.
struct optionalColumns
{
    bool weights = false;
    bool movingDrag = false;
};

void receive(const calcine::link& link, calcine::parcels& parcels, const optionalColumns& columns)
{
    std::vector<uint64_t> ids(parcels.size());
    link.get("id", ids);
    forAll(parcels.ids(), row)
    {
        if (ids[row] != uint64_t(parcels.ids()[row]))
        {
            throw calcine::solverFailure
            (
                CALCINE_FAILURE_INPUT,
                "a force for parcel " + std::to_string(ids[row]) + " in place of parcel "
              + std::to_string(parcels.ids()[row])
            );
        }
    }
    calcine::pushed& push = parcels.push();
    link.get("force", push.force);
    if (columns.movingDrag)
    {
        link.get("drag_coefficient", push.coefficient);
        link.get("gas_velocity", push.gas);
    }
}

// Sends the parcels; `span` is that of the window in s, 0 between windows.
void send
(
    calcine::link& link,
    calcine_kind kind,
    calcine::parcels& parcels,
    const optionalColumns& columns,
    scalar span
)
{
    const label count = parcels.size();
    std::vector<uint64_t> ids, populations;
    vectorField position(count), velocity(count), impulse(count, Zero), drag(count, Zero);
    scalarField radius(count), mass(count), weight(count);
    label row = 0;
    for (const calcine::parcelCloud::parcelType& p : parcels.cloud())
    {
        ids.push_back(parcels.ids()[row]);
        populations.push_back(p.typeId());
        position[row] = p.position();
        velocity[row] = p.U();
        radius[row] = 0.5*p.d();
        mass[row] = p.mass();
        weight[row] = p.nParticle();
        ++row;
    }
    if (span > 0)
    {
        drag = parcels.push().dragImpulse;
        impulse = span*parcels.push().force + drag;
    }
    link.loan(kind, count);
    link.put("id", ids);
    link.put("population", populations);
    link.put("position", position);
    link.put("velocity", velocity);
    link.put("angular_velocity", vectorField(count, Zero));
    link.put("radius", radius);
    link.put("mass", mass);
    link.put("impulse", impulse);
    if (columns.weights)
    {
        link.put("weight", weight);
    }
    if (columns.movingDrag)
    {
        link.put("drag_impulse", drag);
    }
    const vector support = span > 0 ? parcels.push().support : vector::zero;
    link.put("support", scalarList{span, support.x(), support.y(), support.z()});
    link.send();
}

void serve(calcine::link& link, calcine::parcels& parcels, const optionalColumns& columns)
{
    for (;;)
    {
        const calcine_header header = link.receive();
        switch (header.kind)
        {
            case CALCINE_START:
            {
                const scalar span = scalar(header.span_motion)/ticksPerSecond;
                receive(link, parcels, columns);
                parcels.advance(span);
                send(link, CALCINE_FINISHED, parcels, columns, span);
                break;
            }
            // Particles have one attempt a window: what is finished is already the start.
            case CALCINE_COMMIT:
                break;
            case CALCINE_CHECKPOINT:
                parcels.checkpoint(link.text());
                send(link, CALCINE_CHECKPOINTED, parcels, columns, 0);
                break;
            case CALCINE_CHANGE:
                parcels.change(link.text());
                send(link, CALCINE_CHANGED, parcels, columns, 0);
                break;
            case CALCINE_BYE:
                link.loan(CALCINE_BYE, 0);
                link.send();
                return;
            default:
                throw calcine::solverFailure
                (
                    CALCINE_FAILURE_UNSUPPORTED,
                    "a request of kind " + std::to_string(header.kind) + " arrived, which particles do not serve"
                );
        }
    }
}

void run(const argList& args, calcine::link& link)
{
    Time runTime(Time::controlDictName, args);
    sigFpe::unset(false);
    SolverPerformance<scalar>::debug = 0;
    fvMesh mesh
    (
        IOobject(fvMesh::defaultRegion, runTime.timeName(), runTime, IOobject::MUST_READ)
    );
    const calcine::addressing numbers(mesh);
    calcine::compareCells(mesh, numbers);
    const IOdictionary properties
    (
        IOobject("calcineParcels", runTime.constant(), mesh, IOobject::MUST_READ)
    );
    calcine::introduction own(calcine::introduce(properties, mesh, numbers));
    calcine::parcelRows start;
    if (args.found("resume"))
    {
        own.origin = args.opt<fileName>("resume");
        start.read(own.origin);
    }
    else
    {
        start = calcine::parcelRows::ofCase(runTime);
    }
    calcine::parcels parcels(mesh, properties, start);

    own.role = "particles";
    own.name = "OpenFOAM parcels";
    own.cells = parcels.size();
    optionalColumns columns;
    for (const string& column : properties.get<stringList>("catalogue"))
    {
        columns.weights = columns.weights || column.compare(0, 13, "state weight ") == 0;
        columns.movingDrag = columns.movingDrag || column.compare(0, 23, "start drag_coefficient ") == 0;
    }
    link.greet(own);
    Info<< "OpenFOAM " << OPENFOAM << " with " << parcels.size() << " parcels in " << mesh.nCells() << " cells" << endl;
    // Each step of the cloud would tell of itself.
    messageStream::level = 0;
    send(link, CALCINE_STATE, parcels, columns, 0);
    serve(link, parcels, columns);
}

} // End anonymous namespace


int main(int argc, char* argv[])
{
    argList::noFunctionObjects();
    argList::addOption("resume", "dir", "take up the parcels of a checkpoint in this folder");
    argList args(argc, argv);
    return calcine::process("calcineParcelFoam", [&args](calcine::link& link) { run(args, link); });
}
