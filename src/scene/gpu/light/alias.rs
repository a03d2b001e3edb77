//! Alias tables, which choose one of n by weight with one random number and one look-up (Walker 1974).

/// An entry. A random number whose fraction is below `threshold` keeps the entry, any other takes `alias`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Entry {
    pub threshold: f32,
    pub alias: u32,
    /// Probability of this entry's own index.
    pub pmf: f32,
}

/// Builds the table with Vose's method (1991). Weights that are not positive are never chosen. If no weight is positive, all entries
/// are equally likely.
pub(crate) fn table(weights: &[f64]) -> Vec<Entry> {
    let count = weights.len();
    let positive = |w: f64| if w.is_finite() && w > 0.0 { w } else { 0.0 };
    let total: f64 = weights.iter().map(|&w| positive(w)).sum();
    let pmf: Vec<f64> =
        weights.iter().map(|&w| if total > 0.0 { positive(w) / total } else { 1.0 / count as f64 }).collect();
    let mut scaled: Vec<f64> = pmf.iter().map(|p| p * count as f64).collect();
    let mut entries: Vec<Entry> =
        (0..count).map(|i| Entry { threshold: 1.0, alias: i as u32, pmf: pmf[i] as f32 }).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..count).partition(|&i| scaled[i] < 1.0);
    while let (Some(&low), Some(&high)) = (small.last(), large.last()) {
        small.pop();
        entries[low].threshold = scaled[low] as f32;
        entries[low].alias = high as u32;
        scaled[high] -= 1.0 - scaled[low];
        if scaled[high] < 1.0 {
            large.pop();
            small.push(high);
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The probability with which a table really chooses each index, summed over its entries.
    fn realised(entries: &[Entry]) -> Vec<f64> {
        let mut p = vec![0.0; entries.len()];
        for (i, e) in entries.iter().enumerate() {
            let share = 1.0 / entries.len() as f64;
            p[i] += share * f64::from(e.threshold);
            p[e.alias as usize] += share * (1.0 - f64::from(e.threshold));
        }
        p
    }

    #[test]
    fn a_table_gives_each_index_its_probability() {
        for weights in [vec![1.0], vec![1.0, 3.0], vec![0.0, 2.0, 0.0, 6.0, 1e-6], (1..100).map(f64::from).collect()] {
            let total: f64 = weights.iter().sum();
            let entries = table(&weights);
            for ((p, w), e) in realised(&entries).iter().zip(&weights).zip(&entries) {
                assert!((p - w / total).abs() < 1e-6, "{p} for {w} of {total}");
                assert!((f64::from(e.pmf) - w / total).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn without_any_weight_all_are_alike() {
        assert!(realised(&table(&[0.0, f64::NAN, -1.0, 0.0])).iter().all(|p| (p - 0.25).abs() < 1e-9));
    }
}
