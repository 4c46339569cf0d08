#include "parcels.H"
#include "link.H"

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace
{

using namespace Foam;

const char* const cloudName = "parcels";

IOobject named(const char* name, const fvMesh& mesh, IOobject::readOption read)
{
    return IOobject(name, mesh.time().timeName(), mesh, read, IOobject::NO_WRITE);
}

[[noreturn]] void refuse(calcine_failure kind, const std::string& text)
{
    throw calcine::solverFailure(kind, text);
}

} // End anonymous namespace


Foam::calcine::parcelCloud::parcelCloud
(
    const word& name,
    const volScalarField& rho,
    const volVectorField& U,
    const volScalarField& mu,
    const dimensionedVector& g
)
:
    basicKinematicMPPICCloud(name, rho, U, mu, g, false),
    pushed_(pushed::of(rho.mesh()))
{}


void Foam::calcine::parcelCloud::evolve()
{
    if (this->solution().canEvolve())
    {
        parcelType::trackingData td(*this);
        this->solve(*this, td);
    }
    enter(pushed::stage::flight);
}


void Foam::calcine::parcelCloud::enter(pushed::stage next)
{
    if (pushed_.at == next)
    {
        return;
    }
    if (pushed_.at != pushed::stage::flight)
    {
        for (const parcelType& p : *this)
        {
            pushed_.support += p.nParticle()*p.mass()*p.UCorrect();
        }
    }
    pushed_.at = next;
}


Foam::DampingModel<Foam::calcine::parcelCloud::MPPICCloudType>& Foam::calcine::parcelCloud::dampingModel()
{
    enter(pushed::stage::damping);
    return basicKinematicMPPICCloud::dampingModel();
}


Foam::PackingModel<Foam::calcine::parcelCloud::MPPICCloudType>& Foam::calcine::parcelCloud::packingModel()
{
    enter(pushed::stage::packing);
    return basicKinematicMPPICCloud::packingModel();
}


Foam::calcine::parcels::parcels(fvMesh& mesh, const IOdictionary& properties, const parcelRows& start)
:
    mesh_(mesh),
    time_(const_cast<Time&>(mesh.time())),
    U_(named("U", mesh, IOobject::MUST_READ), mesh),
    rho_(named("rho", mesh, IOobject::NO_READ), mesh, dimensionedScalar("rho", dimDensity, 0)),
    mu_(named("mu", mesh, IOobject::NO_READ), mesh, dimensionedScalar("mu", dimPressure*dimTime, 1)),
    pushed_(mesh, properties.get<vector>("gravity"))
{
    fill(start);
}


void Foam::calcine::parcels::fill(const parcelRows& rows)
{
    cloud_.clear();
    // What the cloud's models hold from step to step begins anew, as it does in a process of its own.
    time_.setTime(scalar(0), 0);
    pushed_.resize(rows.id.size());
    pushed_.step = rows.step;
    ids_ = rows.id;
    cloud_.reset
    (
        new parcelCloud(cloudName, rho_, U_, mu_, dimensionedVector("g", dimAcceleration, pushed_.gravity))
    );
    forAll(rows.id, row)
    {
        append(rows, row, row);
    }
}


void Foam::calcine::parcels::append(const parcelRows& rows, label row, label to)
{
    typedef parcelCloud::parcelType parcelType;
    autoPtr<parcelType> made;
    if (rows.coordinates.size())
    {
        made.reset
        (
            new parcelType
            (
                mesh_, rows.coordinates[row], rows.cell[row], rows.tetFace[row], rows.tetPoint[row]
            )
        );
        made->face() = rows.face[row];
    }
    else
    {
        const vector& place = rows.position[row];
        const label celli = mesh_.findCell(place);
        if (celli < 0)
        {
            std::ostringstream text;
            text<< "parcel " << rows.id[row] << " is at (" << place.x() << ", " << place.y() << ", " << place.z()
                << ") m, outside the mesh";
            refuse(CALCINE_FAILURE_LOST_PARTICLES, text.str());
        }
        made.reset(new parcelType(mesh_, place, celli));
    }
    made->origProc() = 0;
    made->origId() = to;
    made->typeId() = rows.population[row];
    made->U() = rows.velocity[row];
    made->d() = rows.diameter[row];
    made->rho() = rows.density[row];
    made->nParticle() = rows.weight[row];
    cloud_->addParticle(made.ptr());
}


Foam::calcine::parcelRows Foam::calcine::parcels::rows() const
{
    const label count = ids_.size();
    parcelRows rows;
    rows.id = ids_;
    rows.step = pushed_.step;
    for (labelList* list : {&rows.population, &rows.cell, &rows.tetFace, &rows.tetPoint, &rows.face})
    {
        list->setSize(count);
    }
    for (scalarField* list : {&rows.diameter, &rows.density, &rows.weight})
    {
        list->setSize(count);
    }
    rows.velocity.setSize(count);
    rows.coordinates.setSize(count);
    label row = 0;
    for (const parcelCloud::parcelType& p : *cloud_)
    {
        rows.population[row] = p.typeId();
        rows.velocity[row] = p.U();
        rows.diameter[row] = p.d();
        rows.density[row] = p.rho();
        rows.weight[row] = p.nParticle();
        rows.coordinates[row] = p.coordinates();
        rows.cell[row] = p.cell();
        rows.tetFace[row] = p.tetFace();
        rows.tetPoint[row] = p.tetPt();
        rows.face[row] = p.face();
        ++row;
    }
    return rows;
}


void Foam::calcine::parcels::advance(scalar span)
{
    pushed_.dragImpulse = Zero;
    pushed_.support = Zero;
    time_.setDeltaT(span, false);
    ++time_;
    cloud_->evolve();
    ++pushed_.step;
    // What the implicit packing solved for is the old solid fraction of its next step, where it cancels but for round-off: a cloud that
    // comes from a checkpoint has none of it.
    const word alpha(word(cloudName) + ":alpha");
    if (mesh_.foundObject<volScalarField>(alpha))
    {
        mesh_.lookupObjectRef<volScalarField>(alpha) = dimensionedScalar(dimless, Zero);
    }
    if (cloud_->size() != ids_.size())
    {
        std::ostringstream text;
        text<< cloud_->size() << " of " << ids_.size() << " parcels are left";
        refuse(CALCINE_FAILURE_LOST_PARTICLES, text.str());
    }
}


Foam::label Foam::calcine::parcels::find(long id) const
{
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    if (found == ids_.end() || *found != id)
    {
        refuse(CALCINE_FAILURE_INPUT, "there is no parcel " + std::to_string(id));
    }
    return found - ids_.begin();
}


void Foam::calcine::parcels::change(const std::string& text)
{
    std::vector<parcelCloud::parcelType*> of;
    of.reserve(ids_.size());
    for (parcelCloud::parcelType& p : *cloud_)
    {
        of.push_back(&p);
    }
    std::vector<bool> gone(ids_.size(), false);
    parcelRows come;
    DynamicList<label> ids, populations;
    DynamicList<vector> places, velocities;
    DynamicList<scalar> diameters, densities, weights;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
    {
        long id = 0, type = 0;
        double x[3], v[3], radius, last, weight = 1;
        if (line == "rest")
        {
            for (parcelCloud::parcelType* p : of)
            {
                p->U() = Zero;
            }
        }
        else if (std::sscanf(line.c_str(), "remove %ld", &id) == 1)
        {
            gone[find(id)] = true;
        }
        else if (std::sscanf(line.c_str(), "resize %ld %lf %lf", &id, &radius, &last) == 3)
        {
            parcelCloud::parcelType& p = *of[find(id)];
            p.d() = 2*radius;
            p.rho() = last/p.volume();
        }
        else if
        (
            std::sscanf
            (
                line.c_str(), "insert %ld %ld %lf %lf %lf %lf %lf %lf %lf %lf %lf", &id, &type, &x[0], &x[1], &x[2],
                &v[0], &v[1], &v[2], &radius, &last, &weight
            ) >= 10
        )
        {
            ids.append(id);
            populations.append(type - 1);
            places.append(vector(x[0], x[1], x[2]));
            velocities.append(vector(v[0], v[1], v[2]));
            diameters.append(2*radius);
            densities.append(last);
            weights.append(weight);
        }
        else if (!line.empty())
        {
            refuse(CALCINE_FAILURE_UNSUPPORTED, "`" + line.substr(0, 60) + "` is no change of parcels");
        }
    }
    DynamicList<label> left(ids_.size());
    for (size_t row = 0; row < of.size(); ++row)
    {
        if (gone[row])
        {
            cloud_->deleteParticle(*of[row]);
        }
        else
        {
            of[row]->origId() = left.size();
            left.append(ids_[row]);
        }
    }
    come.id.transfer(ids);
    come.population.transfer(populations);
    come.position.transfer(places);
    come.velocity.transfer(velocities);
    come.diameter.transfer(diameters);
    come.density.transfer(densities);
    come.weight.transfer(weights);
    forAll(come.id, row)
    {
        if (left.size() && come.id[row] <= left.last())
        {
            refuse
            (
                CALCINE_FAILURE_INPUT,
                "parcel " + std::to_string(come.id[row]) + " comes after parcel " + std::to_string(left.last())
            );
        }
        append(come, row, left.size());
        left.append(come.id[row]);
    }
    ids_.transfer(left);
    pushed_.resize(ids_.size());
}


void Foam::calcine::parcels::checkpoint(const fileName& directory)
{
    rows().write(directory);
    parcelRows written;
    written.read(directory);
    fill(written);
}
