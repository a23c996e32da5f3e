//! Parts of a study that different machines work on.

use std::ops::Range;

/// The most shards.
const MOST: u64 = 1 << 20;

/// A shard of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1 on.
    pub number: u64,
    /// Of how many.
    pub count: u64,
}

impl Shard {
    /// The whole study.
    pub const ALL: Self = Self { number: 1, count: 1 };

    /// Its blocks of `all`.
    pub fn blocks(self, all: u64) -> Range<u64> {
        let border = |k: u64| (u128::from(all) * u128::from(k) / u128::from(self.count)) as u64;
        border(self.number - 1)..border(self.number)
    }

    /// The part of a task of a SLURM job array, whose `variables` tell which task of how many it is.
    ///
    /// # Errors
    /// Says which variable is not there or does not fit.
    pub fn of_job_array(variables: impl Fn(&str) -> Option<String>) -> Result<Self, String> {
        let number = |name: &str| -> Result<u64, String> {
            let text = variables(name).ok_or(format!("auto, but {name} is not set: this is no task of a job array"))?;
            text.parse().map_err(|_| format!("auto, but {name} is {text}: allowed are numbers"))
        };
        let [task, first, count] =
            ["SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_COUNT"].map(number);
        let (task, first, count) = (task?, first?, count?);
        let step = variables("SLURM_ARRAY_TASK_STEP").and_then(|step| step.parse().ok()).filter(|step| *step > 0);
        let place = task.checked_sub(first).filter(|place| place % step.unwrap_or(1) == 0);
        let number = place.map_or(0, |place| place / step.unwrap_or(1) + 1);
        Self::new(number, count)
            .map_err(|error| format!("auto, but {error}: the tasks of the array must be numbered one after the other"))
    }

    fn new(number: u64, count: u64) -> Result<Self, String> {
        if count == 0 || count > MOST {
            return Err(format!("{count} shards, allowed are 1 to {MOST}"));
        }
        if number == 0 || number > count {
            return Err(format!("shard {number} of {count}, allowed are 1 to {count}"));
        }
        Ok(Self { number, count })
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "auto" {
            return Self::of_job_array(|name| std::env::var(name).ok());
        }
        let fields = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        let (number, count) = fields.ok_or("neither auto nor of the form i/n, as in 1/4")?;
        Self::new(number, count)
    }
}

#[cfg(test)]
mod tests {
    use super::Shard;

    fn of(task: &str, first: &str, count: &str, step: &str) -> Result<Shard, String> {
        Shard::of_job_array(|name| {
            let value = match name.strip_prefix("SLURM_ARRAY_TASK_")? {
                "ID" => task,
                "MIN" => first,
                "COUNT" => count,
                "STEP" => step,
                _ => return None,
            };
            (!value.is_empty()).then(|| value.to_owned())
        })
    }

    #[test]
    fn tasks_of_an_array_are_shards() {
        for (task, first, count, step, number) in
            [("0", "0", "4", "", 1), ("7", "4", "4", "1", 4), ("9", "1", "5", "4", 3)]
        {
            let count_of: u64 = count.parse().unwrap();
            assert_eq!(of(task, first, count, step), Ok(Shard { number, count: count_of }));
        }
        for (task, first, count, step, told) in [
            ("", "", "", "", "SLURM_ARRAY_TASK_ID is not set"),
            ("3", "1", "x", "", "SLURM_ARRAY_TASK_COUNT is x"),
            ("7", "1", "3", "", "shard 7 of 3"),
            ("0", "1", "3", "", "shard 0 of 3"),
            ("4", "1", "3", "2", "one after the other"),
        ] {
            let error = of(task, first, count, step).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn shards_are_written_i_of_n() {
        assert_eq!("2/3".parse(), Ok(Shard { number: 2, count: 3 }));
        for bad in ["", "3", "0/3", "4/3", "1/0", "1/2000000"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
