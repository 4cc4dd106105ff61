//! From a fleet's plan to its tails.

use flight::Timestamp;
use units::check_within;
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

use super::life::{Life, LifeEvent, Lives, Recovery};
use super::record::{FleetEvent, PlantedLevel};
use super::{Chosen, FleetPlan, TailEffects, TypeEffect, Upkeep, Work};
use crate::effect::PlannedEffect;
use crate::plan::{Flights, PlanError, TailPlan};
use crate::random::{Purpose, Stream, Streams};

/// Most tails of a fleet: names have three digits.
const MOST_TAILS: usize = 999;

/// A fleet, drawn.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawnFleet {
    pub(crate) tails: Vec<DrawnTail>,
    /// In order of time.
    pub(crate) events: Vec<FleetEvent>,
}

/// A tail of a fleet.
#[derive(Clone, Debug)]
pub(crate) struct DrawnTail {
    /// Name and flights; its effects are below.
    pub(crate) plan: TailPlan,
    pub(crate) effects: Vec<DrawnEffect>,
    pub(crate) lives: Lives,
}

/// An effect of a tail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawnEffect {
    pub(crate) effect: PlannedEffect,
    /// Of the tail over the planned or typical size: scatter and sign.
    pub(crate) factor: f64,
    /// Whose it is; of a plan without a fleet it does not matter.
    pub(crate) level: PlantedLevel,
}

impl DrawnEffect {
    /// As a plan without a fleet has it.
    pub(crate) const fn plain(effect: PlannedEffect) -> Self {
        Self { effect, factor: 1.0, level: PlantedLevel::Tail }
    }
}

/// What draws a fleet.
struct Draw<'a> {
    fleet: &'a FleetPlan,
    seed: u64,
    engines: u8,
    first: Timestamp,
    last: Timestamp,
    names: Vec<String>,
}

impl FleetPlan {
    /// Its tails.
    pub(crate) fn draw(&self, seed: u64, engines: u8) -> Result<DrawnFleet, PlanError> {
        self.check(engines)?;
        let names = (1..=self.tails).map(|number| format!("{}{number:03}", self.prefix)).collect();
        let (first, last) = self.flights.dates;
        let draw = Draw { fleet: self, seed, engines, first, last, names };
        let chosen = |of: &Chosen, key: usize| draw.chosen(of, key);
        let mut of_effects = Vec::new();
        for (key, group) in self.tail_effects.iter().enumerate() {
            of_effects.push(chosen(&group.of, key)?);
        }
        let mut of_events = Vec::new();
        for (key, event) in self.events.iter().enumerate() {
            of_events.push(chosen(&event.of, self.tail_effects.len() + key)?);
        }
        let mut events = Vec::new();
        let mut tails = Vec::with_capacity(self.tails);
        for (place, name) in draw.names.iter().enumerate() {
            let mut effects = draw.of_type(name);
            for (key, group) in self.tail_effects.iter().enumerate() {
                if of_effects[key][place] {
                    effects.extend(draw.of_tail(name, group, key, &mut events));
                }
            }
            let works: Vec<(Timestamp, Work)> = self
                .events
                .iter()
                .zip(&of_events)
                .filter(|(_, of)| of[place])
                .map(|(event, _)| (event.at, event.what))
                .collect();
            let lives = draw.lives(name, &works, &mut events);
            let plan = TailPlan {
                tail: name.clone(),
                effects: Vec::new(),
                engine_deterioration_percent: Vec::new(),
                references: self.references,
                flights: Flights::Designed(self.flights.clone()),
            };
            tails.push(DrawnTail { plan, effects, lives });
        }
        events.sort_by(|one: &FleetEvent, other| {
            (one.at, &one.tail, &one.kind, &one.note).cmp(&(
                other.at,
                &other.tail,
                &other.kind,
                &other.note,
            ))
        });
        Ok(DrawnFleet { tails, events })
    }

    fn check(&self, engines: u8) -> Result<(), PlanError> {
        check_within("tails of a fleet", "-", self.tails as f64, 1.0, MOST_TAILS as f64)?;
        let of_type = self.type_effects.iter().map(|effect| effect.scatter);
        let of_tails = self.tail_effects.iter().map(|group| group.scatter);
        for scatter in of_type.chain(of_tails) {
            check_within("scatter of an effect between tails", "-", scatter, 0.0, 3.0)?;
        }
        let key = |of: &TypeEffect| (of.effect.id, of.effect.from, of.effect.until);
        for (place, one) in self.type_effects.iter().enumerate() {
            if self.type_effects[..place].iter().any(|other| key(other) == key(one)) {
                let (tail, effect) = ("*".to_owned(), one.effect.id.to_string());
                return Err(PlanError::DoubledEffect { tail, effect });
            }
        }
        for upkeep in self.airframe.iter().chain(&self.engines) {
            upkeep.check()?;
        }
        let changes = self.airframe.map_or(0.0, |upkeep| upkeep.changes_per_year);
        check_within("changes of the airframe", "1/year", changes, 0.0, 0.0)?;
        for event in &self.events {
            if let Work::EngineChange { engine, level_percent } = event.what {
                check_within("changed engine", "-", f64::from(engine), 1.0, f64::from(engines))?;
                check_within("level of an engine", "%", level_percent, -20.0, 20.0)?;
            }
        }
        Ok(())
    }
}

impl Upkeep {
    fn check(&self) -> Result<(), PlanError> {
        let days = self.wash_every_days.unwrap_or((1.0, 1.0));
        let checks = [
            ("level between tails", "%", (0.0, self.level_percent), 0.0, 10.0),
            ("deterioration", "%/year", (0.0, self.percent_per_year), 0.0, 10.0),
            ("age on the first date", "years", self.age_years, 0.0, 50.0),
            ("days between washes", "days", days, 1.0, 10_000.0),
            ("share that a wash takes back", "-", (0.0, self.wash_takes_back), 0.0, 1.0),
            ("engine changes", "1/year", (0.0, self.changes_per_year), 0.0, 12.0),
        ];
        for (quantity, unit, (least, most), minimum, maximum) in checks {
            check_within(quantity, unit, least, minimum, maximum)?;
            check_within(quantity, unit, most, least, maximum)?;
        }
        Ok(())
    }
}

impl Draw<'_> {
    /// Of every tail whether it is chosen. Each tail draws a number of its own; the smallest ones are chosen.
    fn chosen(&self, of: &Chosen, key: usize) -> Result<Vec<bool>, PlanError> {
        let all = self.names.len();
        let count = match of {
            Chosen::All => all,
            Chosen::Tails(tails) => {
                if let Some(tail) = tails.iter().find(|tail| !self.names.contains(tail)) {
                    return Err(PlanError::UnknownTail { tail: tail.clone() });
                }
                return Ok(self.names.iter().map(|name| tails.contains(name)).collect());
            }
            Chosen::Drawn(count) => {
                check_within("tails drawn", "-", *count as f64, 0.0, all as f64)?;
                *count
            }
            Chosen::Share(share) => {
                check_within("share of the tails", "-", *share, 0.0, 1.0)?;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a share of at most 999"
                )]
                let count = (share * all as f64).round() as usize;
                count
            }
        };
        let mut order: Vec<(f64, usize)> = self
            .names
            .iter()
            .enumerate()
            .map(|(place, name)| (self.stream(name, key, Purpose::FleetChoice).unit(), place))
            .collect();
        order.sort_by(|one, other| one.0.total_cmp(&other.0));
        let mut chosen = vec![false; all];
        for (_, place) in &order[..count] {
            chosen[*place] = true;
        }
        Ok(chosen)
    }

    fn stream(&self, tail: &str, key: usize, purpose: Purpose) -> Stream {
        Streams::of_flight(self.seed, tail, key).stream(purpose)
    }

    fn of_type(&self, tail: &str) -> Vec<DrawnEffect> {
        let of = |(key, shared): (usize, &TypeEffect)| {
            let drawn = self.stream(tail, key, Purpose::TypeScatter).normal();
            DrawnEffect {
                effect: shared.effect,
                factor: shared.scatter.mul_add(drawn, 1.0),
                level: PlantedLevel::Type,
            }
        };
        self.fleet.type_effects.iter().enumerate().map(of).collect()
    }

    fn of_tail(
        &self,
        tail: &str,
        group: &TailEffects,
        key: usize,
        events: &mut Vec<FleetEvent>,
    ) -> Vec<DrawnEffect> {
        // Everything is drawn whether used or not: a date moves no size.
        let mut random = self.stream(tail, key, Purpose::TailEffect);
        let negative = random.chance(0.5) && group.either_sign.is_on();
        let factor =
            group.scatter.mul_add(random.normal(), 1.0) * if negative { -1.0 } else { 1.0 };
        let share = random.unit();
        let from = group.between.map(|between| midnight(between, share));
        let mut drawn = Vec::new();
        for planned in &group.effects {
            let effect = PlannedEffect { from: from.or(planned.from), ..*planned };
            drawn.push(DrawnEffect { effect, factor, level: PlantedLevel::on_a_tail(effect.id) });
            if let (Some(kind), Some(at)) = (&group.event, effect.from) {
                let note = effect.id.to_string();
                let event = FleetEvent {
                    at,
                    tail: tail.to_owned(),
                    kind: kind.clone(),
                    note,
                    change_percent: None,
                };
                events.push(event);
            }
        }
        drawn
    }

    /// Airframe and engines, if the fleet keeps them up or works on them.
    fn lives(
        &self,
        tail: &str,
        works: &[(Timestamp, Work)],
        events: &mut Vec<FleetEvent>,
    ) -> Lives {
        let of_airframe = |work: &Work| match work {
            Work::Wash => Some(Recovery::Wash(self.airframe().wash_takes_back)),
            _ => None,
        };
        let given = works_of(works, of_airframe);
        let airframe = (self.fleet.airframe.is_some() || !given.is_empty()).then(|| {
            let life = self.life(tail, 0, self.airframe(), given);
            events.extend(rows(tail, &life, "wash", ""));
            life
        });
        let of_engine = |number: u8, work: &Work| match *work {
            Work::EngineWash => Some(Recovery::Wash(self.engines().wash_takes_back)),
            Work::EngineChange { engine, level_percent } if engine == number => {
                Some(Recovery::Exchange(level_percent))
            }
            _ => None,
        };
        let mut engines = Vec::new();
        let worked_on = works.iter().any(|(_, work)| !matches!(work, Work::Wash));
        if self.fleet.engines.is_some() || worked_on {
            for number in 1..=self.engines {
                let given = works_of(works, |work| of_engine(number, work));
                let life = self.life(tail, usize::from(number), self.engines(), given);
                events.extend(rows(tail, &life, "engine_wash", &format!("engine {number}")));
                engines.push(life);
            }
        }
        Lives { airframe, engines }
    }

    fn airframe(&self) -> Upkeep {
        self.fleet.airframe.unwrap_or_default()
    }

    fn engines(&self) -> Upkeep {
        self.fleet.engines.unwrap_or_default()
    }

    /// Of the airframe (0) or an engine: level, age, and its washes and exchanges.
    fn life(&self, tail: &str, key: usize, upkeep: Upkeep, mut events: Vec<LifeEvent>) -> Life {
        let mut random = self.stream(tail, key, Purpose::Lives);
        let level_percent = upkeep.level_percent * random.normal();
        let age_years = random.uniform(upkeep.age_years.0, upkeep.age_years.1);
        // All engines are washed in one night: the dates are the tail's.
        if let Some((least, most)) = upkeep.wash_every_days {
            let mut random = self.stream(tail, key.min(1), Purpose::Washes);
            // The first one falls anywhere within an interval.
            let mut days = random.unit() * random.uniform(least, most);
            while let Some(at) = self.after(days) {
                events.push(LifeEvent { at, what: Recovery::Wash(upkeep.wash_takes_back) });
                days += random.uniform(least, most);
            }
        }
        if upkeep.changes_per_year > 0.0 {
            let mut random = self.stream(tail, key, Purpose::EngineChanges);
            let mean_days = DAYS_PER_YEAR / upkeep.changes_per_year;
            let mut days = random.exponential(mean_days);
            while let Some(at) = self.after(days) {
                let level_percent = upkeep.level_percent * random.normal();
                events.push(LifeEvent { at, what: Recovery::Exchange(level_percent) });
                // A day at least: dates are midnights.
                days += random.exponential(mean_days).max(1.0);
            }
        }
        events.sort_by_key(|event| event.at);
        Life {
            level_percent,
            age_years,
            first: self.first,
            percent_per_year: upkeep.percent_per_year,
            events,
        }
    }

    /// The midnight before so many days after the first date, if it is before the last.
    fn after(&self, days: f64) -> Option<Timestamp> {
        let span_days = (self.last.as_second() - self.first.as_second()) as f64 / SECONDS_PER_DAY;
        (days < span_days).then(|| midnight((self.first, self.last), days / span_days))
    }
}

/// The midnight before a share of the way between two instants; not before the first of them.
fn midnight((from, to): (Timestamp, Timestamp), share: f64) -> Timestamp {
    const DAY_S: i64 = 86_400;
    #[expect(clippy::cast_possible_truncation, reason = "seconds, far below 2^53")]
    let after_s = (share * (to.as_second() - from.as_second()) as f64) as i64;
    let at_s = (from.as_second() + after_s).div_euclid(DAY_S) * DAY_S;
    Timestamp::from_second(at_s).map_or(from, |at| at.max(from))
}

fn works_of(works: &[(Timestamp, Work)], of: impl Fn(&Work) -> Option<Recovery>) -> Vec<LifeEvent> {
    works.iter().filter_map(|(at, work)| Some(LifeEvent { at: *at, what: of(work)? })).collect()
}

/// The rows of `EVENTS.csv` of one airframe or engine.
fn rows<'a>(
    tail: &'a str,
    life: &'a Life,
    wash: &'a str,
    note: &'a str,
) -> impl Iterator<Item = FleetEvent> + 'a {
    life.events.iter().enumerate().map(move |(place, event)| FleetEvent {
        at: event.at,
        tail: tail.to_owned(),
        kind: match event.what {
            Recovery::Wash(_) => wash.to_owned(),
            Recovery::Exchange(_) => "engine_change".to_owned(),
        },
        note: note.to_owned(),
        change_percent: Some(life.change_percent(place)),
    })
}
